//! The settings of a board at work, which are asked for and changed over its link.

use embassy_sync::mutex::Mutex;

use super::{Editable, SLOT, Serial, SettingsError};
use crate::crossing::Lock;
use crate::ports::Store;

/// Settings that parts of an instrument read and change.
pub type SharedSettings = Mutex<Lock, dyn Editable>;

/// The settings of a board.
#[derive(Clone, Copy)]
pub struct BoardSettings<'c> {
    /// They.
    pub settings: &'c SharedSettings,
    /// Serial number of its controller, to which a record of them belongs.
    pub serial: Serial,
}

impl BoardSettings<'_> {
    /// Has a store keep them.
    ///
    /// # Errors
    /// [`SettingsError::OutOfRange`] and [`SettingsError::NotSaved`]; an earlier record stays then.
    pub(crate) async fn save<T: Store>(&self, store: &mut T) -> Result<(), SettingsError> {
        let record = self.settings.lock().await.to_record(&self.serial)?;
        store.save(SLOT, &record).await.map_err(SettingsError::NotSaved)
    }
}
