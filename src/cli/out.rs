//! What goes to the two streams: results to standard output, everything else to standard error.

use super::code;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

/// Prints a result. A reader that has closed the pipe has read enough; any other failure is one.
pub fn result(text: &str) -> Result<(), ExitCode> {
    let mut out = std::io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            let message = format!("cannot write to standard output: {error}");
            Err(fail(code::SYSTEM, &message))
        }
        _ => Ok(()),
    }
}

/// Prints one JSON object as a result.
pub fn json(value: &impl serde::Serialize) -> Result<(), ExitCode> {
    match serde_json::to_string_pretty(value) {
        Ok(text) => result(&format!("{text}\n")),
        Err(error) => Err(fail(code::SYSTEM, &format!("cannot write JSON: {error}"))),
    }
}

/// Prints a message as it is; that nobody can read it is no reason to stop.
pub fn message(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// Prints a warning.
pub fn warn(text: &str) {
    message(&format!("warning: {text}\n"));
}

/// Prints an error and gives the exit code.
pub fn fail(code: u8, text: &str) -> ExitCode {
    message(&format!("error: {text}\n"));
    ExitCode::from(code)
}

/// A number of bytes for people.
pub fn bytes(count: f64) -> String {
    let (scale, unit) = match count {
        count if count >= 1e9 => (1e9, "GB"),
        count if count >= 1e6 => (1e6, "MB"),
        count if count >= 1e3 => (1e3, "kB"),
        _ => return format!("{count:.0} B"),
    };
    format!("{:.1} {unit}", count / scale)
}

/// A duration for people.
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.2} µs", s * 1e6),
        s if s < 1.0 => format!("{:.0} ms", s * 1e3),
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 48.0 * 3600.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86400.0),
    }
}
