//! Pages in a real browser: how wide they come out, and a picture of them.

use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::{run, skip};

const PROGRAMS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// A browser that this machine has.
pub struct Browser {
    program: &'static str,
}

impl Browser {
    /// The one that is installed. Without any, that is said.
    ///
    /// # Panics
    /// If there is none where `CI` is set.
    pub fn installed() -> Option<Self> {
        let answers = |program: &&&str| {
            Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
        };
        let program = PROGRAMS.iter().find(answers).copied();
        if program.is_none() {
            skip("pages in a browser, for want of chromium");
        }
        program.map(|program| Self { program })
    }

    /// How many pixels wide a page is in a window of some width: more, if something sticks out.
    ///
    /// # Panics
    /// If the browser fails.
    pub fn width(&self, page: &Path, window: u32) -> u32 {
        let folder = tempfile::tempdir().expect("there is room for a page");
        let around = folder.path().join("around.html");
        let shown = address(page).into_string().expect("test folders have plain names");
        let text = format!(
            "<body><iframe src='{shown}' style='width:{window}px;height:900px;border:0'></iframe><script>\
             onload = () => document.title = 'width ' + frames[0].document.documentElement.scrollWidth</script>"
        );
        fs::write(&around, text).expect("the folder can be written");
        let mut command = self.command(folder.path());
        command.args(["--allow-file-access-from-files", "--virtual-time-budget=5000", "--dump-dom"]);
        let output = run(command.arg(address(&around)));
        let dom = String::from_utf8_lossy(&output.stdout).into_owned();
        let said = dom.split("<title>width ").nth(1).and_then(|rest| rest.split('<').next());
        said.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("no width in {dom}"))
    }

    /// Takes a picture of the top of a page.
    ///
    /// # Panics
    /// If the browser fails, or leaves no picture.
    pub fn picture(&self, page: &Path, (width, height): (u32, u32), out: &Path) {
        let folder = tempfile::tempdir().expect("there is room for a profile");
        let mut screenshot = OsString::from("--screenshot=");
        screenshot.push(out);
        let mut command = self.command(folder.path());
        run(command.arg(screenshot).arg(format!("--window-size={width},{height}")).arg(address(page)));
        assert!(out.exists(), "no picture in {}", out.display());
    }

    /// Without windows, network services and a profile that others use.
    fn command(&self, folder: &Path) -> Command {
        let mut command = Command::new(self.program);
        let mut profile = OsString::from("--user-data-dir=");
        profile.push(folder.join("profile"));
        command.args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run"]);
        command.args(["--disable-background-networking", "--disable-component-update", "--disable-sync"]);
        command.arg(profile);
        command
    }
}

fn address(page: &Path) -> OsString {
    let mut address = OsString::from("file://");
    address.push(page);
    address
}
