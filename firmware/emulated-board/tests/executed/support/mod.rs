//! What the tests share: images that are built once, executions that are made once, and defects that are known.

pub mod bench;
pub mod defect;
pub mod executed;
#[path = "../../support/images.rs"]
pub mod images;
pub mod worlds;
