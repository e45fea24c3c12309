//! The settings of a device.

use sprag_shared::link::{Identity, Reply, Request, WORD_BLOCK, Words};
use sprag_shared::settings::{COUNT, LAYOUT, Settings};

use super::line::{DeviceError, Line};
use super::session::Session;

/// Words mean the same at both ends only if both have the same settings in the same order.
fn same_settings(identity: &Identity) -> Result<(), DeviceError> {
    if usize::from(identity.settings) != COUNT {
        return Err(DeviceError::Settings { device: identity.settings, own: COUNT });
    }
    if identity.layout != LAYOUT {
        return Err(DeviceError::Layout { device: identity.layout, own: LAYOUT });
    }
    Ok(())
}

/// Reads all of them.
///
/// # Errors
/// [`DeviceError::Settings`] or [`DeviceError::Layout`] of a device with others, or as [`Session::ask`].
pub fn read<L: Line>(session: &mut Session<L>) -> Result<Settings, DeviceError> {
    same_settings(&session.identify()?)?;
    let mut words = [0; COUNT];
    let mut first = 0;
    while first < COUNT {
        let wanted = |reply| if let Reply::Words(block) = reply { Some(block) } else { None };
        let block = session.ask(&Request::Read { first: first as u16 }, wanted)?;
        let count = usize::from(block.count).min(WORD_BLOCK).min(COUNT - first);
        if count == 0 || usize::from(block.first) != first {
            return Err(DeviceError::Confused("its settings"));
        }
        words[first..first + count].copy_from_slice(&block.words[..count]);
        first += count;
    }
    Settings::from_words(&words).map_err(|error| DeviceError::Setting(error.describe(&Settings::default()).to_string()))
}

/// Writes all of them and puts them in force; also into flash where they shall be kept (`store`).
///
/// # Errors
/// As [`read`], and [`DeviceError::Refused`] while the block rocks.
pub fn write<L: Line>(session: &mut Session<L>, settings: &Settings, store: bool) -> Result<(), DeviceError> {
    same_settings(&session.identify()?)?;
    for (number, block) in settings.words().chunks(WORD_BLOCK).enumerate() {
        let mut words = [0; WORD_BLOCK];
        words[..block.len()].copy_from_slice(block);
        session.order(&Request::Write(Words { first: (number * WORD_BLOCK) as u16, count: block.len() as u8, words }))?;
    }
    session.order(&Request::Apply { check: settings.check(), store })?;
    Ok(())
}
