//! Examples behind the help of each command; a test runs every one of them.

/// Of the program, and what its exit code says.
pub const PROGRAM: &str = "\
Examples:
  meridian
      A whole board on simulated chips finds north.
  meridian replay drive.csv.gz
      The azimuth of a vehicle from what its gyros recorded.
  meridian run vehicle --help
      The options of a platform, by groups.

The exit code is 0 with a result, 1 where it is refused or failed with its
reason, 2 for misuse.";

/// Of `run stage`.
pub const STAGE: &str = "\
Examples:
  meridian run --latitude 47°35′ --azimuth 30 --pitch 2
      North at that latitude, on a base that is inclined.
  meridian run stage --sigma 0.05 --report page.html
      Goes on until 0.05° (1σ) are reached, and draws a page.
  meridian run stage --fault encoder-slip
      What becomes of it where the encoder slips.";

/// Of `run two-frame`.
pub const TWO_FRAME: &str = "\
Examples:
  meridian run two-frame --passes 2
      Four headings, visited twice.
  meridian run two-frame --handover 213.7,0.16
      An azimuth from outside, kept.";

/// Of `run turntable`.
pub const TURNTABLE: &str = "\
Examples:
  meridian run turntable --turns 10
      A platform that turns ten times each way.
  meridian run turntable --flash board.flash --date 2026-03-14
      Keeps its axis misalignment in a file for later runs.";

/// Of `run vehicle`.
pub const VEHICLE: &str = "\
Examples:
  meridian run vehicle --stops 2 --drive-seconds 300
      North from two stops and a drive.
  meridian run vehicle --hold 900 --realign --record run.jsonl
      Keeps its azimuth, aligns anew at stops, and records all.";

/// Of `run spin`.
pub const SPIN: &str = "\
Examples:
  meridian run spin --turns-per-second 80
      The roll of a body that makes 80 turns a second.
  meridian run spin --fault lift-gone -v
      Without a lift, with the log.";

/// Of `run`.
pub const RUN: &str = "\
Examples:
  meridian run
      A gyro on a single-axis stage.
  meridian run vehicle --latitude 52N
      Three gyros in a vehicle that stops, drives and stops again.
  meridian run stage --fault list
      The names of what may go wrong.";

/// Of `replay`.
pub const REPLAY: &str = "\
Examples:
  meridian replay stage.csv.gz --latitude 47°35′
      North from a recording, with another latitude than its header has.
  meridian replay drive.csv.gz --method vertical --attitude-out attitude.csv
      Pitch and roll, sample by sample.
  meridian replay recordings
      All recordings of a folder, in a table.
  meridian replay - --json
      A recording from standard input, for a program.";

/// Of `plan`.
pub const PLAN: &str = "\
Examples:
  meridian plan --arw 0.001 --bias-instability 0.007 --latitude 48 --sigma 0.05
      The least time for 0.05° (1σ).
  meridian plan --arw 0.06 --ramp 2 --latitude 48°N --seconds 300
      The best that can be had in five minutes.";

/// Of `allan`.
pub const ALLAN: &str = "\
Examples:
  meridian allan rest.csv.gz
      The noise of a gyro at rest.
  meridian allan rest.csv.gz --column g_rad_s --report noise.html
      Of one column, with the curve as a page.";

/// Of `campaign`.
pub const CAMPAIGN: &str = "\
Examples:
  meridian campaign instrument --runs 5
      Five boards, their errors beside the limit.
  meridian campaign disturbed --class base-turn --runs 5
      One class of faults.";

/// Of `emulate`.
pub const EMULATE: &str = "\
Examples:
  meridian emulate
      The firmware in QEMU against the host, bit for bit.
  meridian emulate --board stage
      The very image that is flashed for a stage.";

/// Of `log`.
pub const LOG: &str = "\
Examples:
  meridian log board.elf pages.bin
      The lines that the board kept, of a dump of its flash.
  meridian log board.elf /dev/ttyACM0
      The same, asked for over its link.";

/// Of `send`.
pub const SEND: &str = "\
Examples:
  meridian send /dev/ttyACM0 start
      Begins an alignment.
  meridian send COM3 azimuth 213.7 0.5
      States an azimuth and its 1σ from outside.
  meridian send tcp:5000 log --json
      The log that is kept in flash, of an emulated board.";

/// Of `settings`.
pub const SETTINGS: &str = "\
Examples:
  meridian settings /dev/ttyACM0 get
      All settings.
  meridian settings /dev/ttyACM0 set latitude -47.58
      Changes one until the instrument is switched off.
  meridian settings /dev/ttyACM0 save board.toml
      Keeps all in a file.
  meridian settings /dev/ttyACM0 load board.toml
      Takes them from a file, and keeps them in flash.";

/// Of `settings get`.
pub const SETTINGS_GET: &str = "\
Examples:
  meridian settings /dev/ttyACM0 get latitude carrier
      One setting, and what carries the instrument.";

/// Of `settings set`.
pub const SETTINGS_SET: &str = "\
Examples:
  meridian settings COM3 set latitude 47.58 dwell 10
      Two settings.
  meridian settings COM3 set latitude=47.58
      The same in another way.";

/// Of `settings save`.
pub const SETTINGS_SAVE: &str = "\
Examples:
  meridian settings tcp:5000 save board.toml
      The settings of an emulated board.";

/// Of `settings load`.
pub const SETTINGS_LOAD: &str = "\
Examples:
  meridian settings /dev/ttyACM0 load board.toml
      What this board had before.
  meridian settings /dev/ttyACM0 load board.toml --other-board
      The settings of another board, without its calibrations.";

/// Of `doctor`.
pub const DOCTOR: &str = "\
Examples:
  meridian doctor
      What is there, what is missing, and the commands that bring it.
  meridian doctor --json
      The same for a program.";

/// Of `completions`.
pub const COMPLETIONS: &str = "\
Examples:
  meridian completions bash > meridian.bash
      For `source meridian.bash`, or a folder that bash reads completions from.
  meridian completions fish > ~/.config/fish/completions/meridian.fish
      For every fish that starts from now on.";

/// Of `man`.
pub const MAN: &str = "\
Examples:
  meridian man > meridian.1
      Of the program.
  meridian man run vehicle > meridian-run-vehicle.1
      Of a command.";
