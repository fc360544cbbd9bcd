//! What the user sees of a spinning body's roll: result block, JSON object, campaign.

pub mod campaign;
pub mod json;
pub mod text;
