//! Loads settings from a file into an instrument: all of those that differ, or none.

use super::{Snapshot, is_calibration, read, value};
use crate::interrupt;
use crate::link::conversation::Conversation;

/// What is to be loaded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Plan {
    /// Settings that differ: name, value there was, value that is to be.
    pub changes: Vec<[String; 3]>,
    /// How many settings of the file the instrument has already.
    pub same: usize,
    /// Calibrations of another board, which are left out.
    pub left_out: Vec<String>,
    /// Settings of the instrument that the file does not have.
    pub not_in_file: Vec<String>,
}

/// What was loaded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Loaded {
    /// What was to be loaded; each value is the one that is kept now.
    pub plan: Plan,
    /// Values that the instrument keeps otherwise than the file has them.
    pub rounded: Vec<String>,
}

/// A change that an instrument has taken, or may have: name, and the value there was.
type Made = [String; 2];

/// What of a file is to be loaded into an instrument; where that is another board, calibrations are left out if `other_board`
/// allows it.
///
/// # Errors
/// The file is of another carrier or board, or has a setting that the instrument does not have.
pub fn plan(file: &Snapshot, instrument: &Snapshot, other_board: bool) -> Result<Plan, String> {
    check_carrier(file, instrument)?;
    let unknown = file.settings.keys().filter(|name| !instrument.settings.contains_key(*name));
    let unknown: Vec<_> = unknown.cloned().collect();
    if !unknown.is_empty() {
        let names = unknown.join(", ");
        return Err(format!("the instrument has no setting {names}; nothing was changed"));
    }
    let is_of_board = file.identity("serial").is_some()
        && file.identity("serial") == instrument.identity("serial");
    let calibrations = file.settings.keys().filter(|name| is_calibration(name));
    let foreign: Vec<_> = calibrations.filter(|_| !is_of_board).cloned().collect();
    if !foreign.is_empty() && !other_board {
        return Err(of_other_board(file, instrument, &foreign));
    }
    let mut plan = Plan { left_out: foreign, ..Plan::default() };
    for (name, now) in &instrument.settings {
        match file.settings.get(name) {
            _ if plan.left_out.contains(name) => {}
            None => plan.not_in_file.push(name.clone()),
            Some(wanted) if value::are_same(wanted, now) => plan.same += 1,
            Some(wanted) => plan.changes.push([name, now, wanted].map(Clone::clone)),
        }
    }
    Ok(plan)
}

/// Refuses settings for another carrier.
fn check_carrier(file: &Snapshot, instrument: &Snapshot) -> Result<(), String> {
    let [of_file, of_instrument] = [file, instrument].map(|it| it.identity("carrier"));
    match (of_file, of_instrument) {
        (Some(one), Some(other)) if one == other => Ok(()),
        (Some(one), Some(other)) => Err(format!(
            "the settings are those of the carrier {one}, and the instrument is on the carrier {other}; nothing was changed"
        )),
        (None, _) => Err("the file states no carrier; nothing was changed".to_owned()),
        (_, None) => Err("the instrument states no carrier; nothing was changed".to_owned()),
    }
}

/// That calibrations are those of another board.
fn of_other_board(file: &Snapshot, instrument: &Snapshot, calibrations: &[String]) -> String {
    let [of_file, of_instrument] =
        [file, instrument].map(|it| it.identity("serial").unwrap_or("unknown").to_owned());
    format!(
        "calibrations are those of one board: {} are of the board {of_file}, and this is the board {of_instrument}; nothing \
         was changed; --other-board loads all but these",
        calibrations.join(", ")
    )
}

/// Loads what is planned, has it kept in flash, and reads it back. Where anything is refused, the values that were there
/// before are set again, and nothing is kept.
///
/// # Errors
/// What was refused, and what became of the rest.
pub fn load(instrument: &mut Conversation, plan: Plan, file: &Snapshot) -> Result<Loaded, String> {
    let (mut made, mut loaded) = (Vec::new(), Loaded { plan, ..Loaded::default() });
    let changed = change_all(instrument, &mut loaded, &mut made);
    changed.map_err(|why| format!("{why}; {}", restored(instrument, &made)))?;
    let saved = instrument.say(&["save"]).map_err(|why| {
        format!("{why}; all settings are set, but whether they are saved is not known: load them once more")
    })?;
    let refused = saved.done("save").err();
    if let Some(why) = refused {
        return Err(format!("{why}; {}", restored(instrument, &made)));
    }
    verify(instrument, &loaded.plan, file)?;
    Ok(loaded)
}

/// Sets all values that are to be loaded. Each must be possible together with those that the others have at that time: what is
/// refused is tried once more after others were taken.
fn change_all(
    instrument: &mut Conversation,
    loaded: &mut Loaded,
    made: &mut Vec<Made>,
) -> Result<(), String> {
    let mut left: Vec<_> = loaded.plan.changes.iter_mut().collect();
    while !left.is_empty() {
        let (mut refused, mut reason, mut is_changed) = (Vec::new(), None, false);
        for entry in left {
            let [name, before, wanted] = entry;
            match change(instrument, [name, before, wanted], made)? {
                Ok(kept) => {
                    let is_rounded = !value::are_same(&kept, wanted);
                    let rounded =
                        is_rounded.then(|| format!("{name} = {wanted} is kept as {kept}"));
                    loaded.rounded.extend(rounded);
                    *wanted = kept;
                    is_changed = reason.is_some();
                }
                Err(why) => {
                    reason.get_or_insert(why);
                    refused.push(entry);
                }
            }
        }
        if let Some(why) = reason.filter(|_| !is_changed) {
            return Err(why);
        }
        left = refused;
    }
    Ok(())
}

/// Sets one value; what is kept, or why it is refused. One that is not known to be kept is restored with the others.
///
/// # Errors
/// There was no answer.
fn change(
    instrument: &mut Conversation,
    [name, before, wanted]: [&str; 3],
    made: &mut Vec<Made>,
) -> Result<Result<String, String>, String> {
    if interrupt::is_asked() {
        return Err(interrupt::reason());
    }
    made.push([name, before].map(str::to_owned));
    let reply = instrument.say(&["set", name, wanted])?;
    if reply.refused.is_some() {
        made.pop();
    }
    let done = reply.done(&format!("set {name} {wanted}"));
    Ok(done.map(|reply| {
        reply.values.into_iter().next().map_or_else(|| wanted.to_owned(), |(_, kept)| kept)
    }))
}

/// Sets the values again that were there before, the last one first; what became of that.
fn restored(instrument: &mut Conversation, made: &[Made]) -> String {
    let mut left: Vec<&str> = Vec::new();
    let mut is_there = true;
    for [name, before] in made.iter().rev() {
        let reply = is_there.then(|| instrument.say(&["set", name, before]));
        is_there = matches!(reply, Some(Ok(_)));
        let is_done = matches!(reply, Some(Ok(reply)) if reply.refused.is_none());
        if !is_done {
            left.push(name);
        }
    }
    match (made, left.as_slice()) {
        ([], _) => "nothing was changed, and nothing saved".to_owned(),
        (_, []) => {
            "the values that were there before are set again, and nothing was saved".to_owned()
        }
        (_, left) => format!(
            "{} could not be set back, and may be changed until the instrument starts anew; nothing was saved",
            left.join(", ")
        ),
    }
}

/// Reads all settings back, and holds them to those that were set, and to the file's that were there already.
fn verify(instrument: &mut Conversation, plan: &Plan, file: &Snapshot) -> Result<(), String> {
    let now =
        read::all(instrument).map_err(|why| format!("it was saved, but not read back: {why}"))?;
    let changed = |name: &String| plan.changes.iter().find(|[changed, ..]| changed == name);
    let loaded = file.settings.iter().filter(|(name, _)| !plan.left_out.contains(name));
    let differing = loaded.filter_map(|(name, wanted)| {
        let wanted = changed(name).map_or(wanted, |[.., kept]| kept);
        let found = now.settings.get(name).map_or("nothing", String::as_str);
        (!value::are_same(found, wanted)).then(|| format!("{name} is {found} and not {wanted}"))
    });
    let differing: Vec<_> = differing.collect();
    if differing.is_empty() {
        return Ok(());
    }
    Err(format!("the settings were saved, but read back otherwise: {}", differing.join(", ")))
}
