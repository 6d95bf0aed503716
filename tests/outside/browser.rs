//! The report page in real headless Chromium, driven through its debugging pipe.
//!
//! Skipped with a message where Chromium is not installed, unless `EDGELINE_REQUIRE_BROWSER` is
//! set; `tests/all.sh` installs it and sets that.

use crate::support::{edgeline, number, rows, succeeded};
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(60);

/// A page in its own browser.
struct Page {
    child: Child,
    input: ChildStdin,
    messages: Receiver<Value>,
    events: VecDeque<Value>,
    session: Option<String>,
    next: u64,
    /// The browser's temporary profile.
    _profile: tempfile::TempDir,
}

impl Drop for Page {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn chromium() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|program| program.is_file())
}

/// Messages of the pipe, which end with a zero byte each.
fn listen(output: ChildStdout) -> Receiver<Value> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        let mut output = BufReader::new(output);
        let mut buffer = Vec::new();
        while output.read_until(0, &mut buffer).is_ok_and(|n| n > 0) {
            buffer.pop();
            let Ok(message) = serde_json::from_slice(&buffer) else { break };
            if sender.send(message).is_err() {
                break;
            }
            buffer.clear();
        }
    });
    receiver
}

impl Page {
    /// Opens a file in a window of this size.
    fn open(program: &Path, file: &Path) -> Self {
        let profile = tempfile::tempdir().unwrap();
        // The browser talks on the descriptors 3 and 4: the shell puts its own pipes there.
        let mut child = Command::new("sh")
            .args(["-c", "exec \"$@\" 3<&0 4>&1 </dev/null >/dev/null 2>&1", "sh"])
            .arg(program)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-quic",
                "--no-first-run",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-sync",
                "--hide-scrollbars",
                "--remote-debugging-pipe",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let input = child.stdin.take().unwrap();
        let messages = listen(child.stdout.take().unwrap());
        let mut page = Self {
            child,
            input,
            messages,
            events: VecDeque::new(),
            session: None,
            next: 0,
            _profile: profile,
        };
        let target = page.call("Target.createTarget", json!({ "url": "about:blank" }));
        let arguments = json!({ "targetId": target["targetId"], "flatten": true });
        let session = page.call("Target.attachToTarget", arguments);
        page.session = session["sessionId"].as_str().map(str::to_string);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            page.call(&format!("{domain}.enable"), json!({}));
        }
        page.resize(1280, 900);
        let url = format!("file://{}", file.canonicalize().unwrap().display());
        page.call("Page.navigate", json!({ "url": url }));
        page.wait("document.documentElement?.dataset.ready === 'yes'");
        page
    }

    /// Calls a method of the protocol and returns its result; events on the way are kept.
    fn call(&mut self, method: &str, params: Value) -> Value {
        self.next += 1;
        let mut message = json!({ "id": self.next, "method": method, "params": params });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        let mut bytes = message.to_string().into_bytes();
        bytes.push(0);
        self.input.write_all(&bytes).unwrap();
        loop {
            let answer = self.messages.recv_timeout(PATIENCE).expect("the browser answers");
            if answer["id"] == self.next {
                assert!(answer.get("error").is_none(), "{method}: {}", answer["error"]);
                return answer["result"].clone();
            }
            self.events.push_back(answer);
        }
    }

    /// Value of a JavaScript expression.
    fn eval(&mut self, expression: &str) -> Value {
        let arguments = json!({ "expression": expression, "returnByValue": true });
        let result = self.call("Runtime.evaluate", arguments);
        assert!(result.get("exceptionDetails").is_none(), "{expression}: {result}");
        result["result"]["value"].clone()
    }

    fn text(&mut self, expression: &str) -> String {
        self.eval(expression).as_str().unwrap_or_default().to_string()
    }

    fn wait(&mut self, condition: &str) {
        let began = Instant::now();
        while self.eval(condition) != json!(true) {
            assert!(began.elapsed() < PATIENCE, "waited in vain for {condition}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    fn resize(&mut self, width: u32, height: u32) {
        let mobile = width < 600;
        let size =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile });
        self.call("Emulation.setDeviceMetricsOverride", size);
    }

    fn scheme(&mut self, scheme: &str) {
        let features = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
        self.call("Emulation.setEmulatedMedia", features);
    }

    fn press(&mut self, key: &str) {
        for kind in ["keyDown", "keyUp"] {
            self.call("Input.dispatchKeyEvent", json!({ "type": kind, "key": key }));
        }
    }

    /// Chooses a value of a select as a user does.
    fn choose(&mut self, id: &str, value: &str) {
        let script = format!(
            "(() => {{ const s = document.getElementById('{id}'); s.value = '{value}'; \
             s.dispatchEvent(new Event('change', {{ bubbles: true }})); return s.value; }})()"
        );
        assert_eq!(self.text(&script), value, "{id} offers {value}");
    }

    /// Saves a picture of the window and returns its size.
    fn picture(&mut self, path: &Path) -> (u32, u32) {
        let shot = self.call("Page.captureScreenshot", json!({ "format": "png" }));
        let png = base64(shot["data"].as_str().unwrap());
        std::fs::write(path, &png).unwrap();
        assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
        let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
        (number(16), number(20))
    }

    /// Errors of the page, and its requests to the network.
    fn complaints(&mut self) -> Vec<String> {
        self.events
            .iter()
            .filter_map(|e| {
                let (method, p) = (e["method"].as_str()?, &e["params"]);
                match method {
                    "Runtime.exceptionThrown" => Some(p["exceptionDetails"].to_string()),
                    "Runtime.consoleAPICalled" if p["type"] == "error" => Some(p.to_string()),
                    "Log.entryAdded" if p["entry"]["level"] == "error" => Some(p.to_string()),
                    "Network.requestWillBeSent" => {
                        let url = p["request"]["url"].as_str()?;
                        let own = url.starts_with("file:") || url.starts_with("data:");
                        (!own).then(|| format!("asked for {url}"))
                    }
                    _ => None,
                }
            })
            .collect()
    }
}

/// Bytes of a base64 text.
fn base64(text: &str) -> Vec<u8> {
    let value = |c: u8| match c {
        b'A'..=b'Z' => u32::from(c - b'A'),
        b'a'..=b'z' => u32::from(c - b'a') + 26,
        b'0'..=b'9' => u32::from(c - b'0') + 52,
        b'+' => 62,
        _ => 63,
    };
    let mut bytes = Vec::new();
    for four in text.as_bytes().chunks(4) {
        let kept = four.iter().filter(|c| **c != b'=').count();
        let bits = four.iter().take(kept).fold(0, |b, &c| b << 6 | value(c)) << (6 * (4 - kept));
        bytes.extend_from_slice(&bits.to_be_bytes()[1..kept]);
    }
    bytes
}

/// A number as the page shows it.
fn shown(text: &str) -> f64 {
    text.replace('−', "-").parse().unwrap_or_else(|_| panic!("{text:?} is a number"))
}

/// A run of two flush cases, one of them without a FEM record.
fn study(folder: &Path) -> PathBuf {
    std::fs::write(
        folder.join("two.toml"),
        "name = \"two\"\n[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = 0.3\n[block]\n\
         young_pa = 210e9\npoisson = 0.3\n[factors]\nW = [1e-3]\nS_l = [5.0, 6.0]\nL_r = [1.0]\n",
    )
    .unwrap();
    let out = folder.join("run");
    succeeded(&mut edgeline(folder, &["study", "two.toml", "--repeats", "1", "--out", "run"]));
    out
}

#[test]
fn the_page_works_in_a_browser() {
    let Some(program) = chromium() else {
        assert!(
            std::env::var_os("EDGELINE_REQUIRE_BROWSER").is_none(),
            "Chromium is not on the PATH"
        );
        eprintln!("skipped: Chromium is not on the PATH");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let out = study(folder.path());
    let file = out.join("report.html");
    assert!(std::fs::metadata(&file).unwrap().len() < 5 << 20);
    let mut page = Page::open(&program, &file);

    // The verdict comes first, and the cases are those of the run.
    let head = page.text("document.querySelector('header').innerText");
    assert!(head.contains("quarter-space is off FEM by"), "{head}");
    assert_eq!(page.eval("document.getElementById('case').options.length"), json!(2));

    // A selector changes the curve and its description.
    let path =
        "document.querySelector('#chart path[data-source=\"quarter-space\"]').getAttribute('d')";
    let before = page.text(path);
    page.choose("body", "block");
    page.choose("curve", "depth-0.9");
    page.choose("quantity", "sigma_yy");
    let after = page.text(path);
    assert!(!before.is_empty() && !after.is_empty() && before != after);
    let title = page.text("document.querySelector('#chart .axis-title:last-of-type').textContent");
    let titles = page.text(
        "[...document.querySelectorAll('#chart .axis-title')].map((t) => t.textContent).join('|')",
    );
    assert!(titles.contains("z / C") && titles.contains("σyy / p0"), "{titles} {title}");

    // By keyboard from point to point; the values are those of the files.
    let study_rows = rows(&out.join("study.csv"));
    let case = "w1e-3_sl5_lr1";
    let of_case = study_rows.iter().find(|r| r["case"] == case).expect("the case is there");
    let (c_m, p0_pa) = (number(of_case, "c_m"), number(of_case, "p0_pa"));
    let curve: Vec<_> = rows(&out.join("curves.csv"))
        .into_iter()
        .filter(|r| r["case"] == case && r["body"] == "block" && r["curve"] == "depth-0.9")
        .collect();
    page.eval("document.getElementById('chart').focus()");
    page.press("Home");
    let mut compared = 0;
    for step in 0..12 {
        let place = page.text("document.getElementById('place').textContent");
        let z = shown(place.split("z = ").nth(1).unwrap().trim_end_matches(" C"));
        for source in ["half-space", "mirror", "guilbault", "quarter-space", "fem"] {
            let cell = format!(
                "document.querySelector('#readout tr[data-source=\"{source}\"]').cells[1].textContent"
            );
            let value = shown(&page.text(&cell));
            let row = curve
                .iter()
                .find(|r| r["source"] == source && (number(r, "z_m") / c_m - z).abs() < 6e-4)
                .unwrap_or_else(|| panic!("{source} at z = {z}, step {step}"));
            let expected = number(row, "sigma_yy_pa") / p0_pa;
            assert!((value - expected).abs() < 6e-5, "{source} at {z}: {value}, not {expected}");
            compared += 1;
        }
        page.press("ArrowRight");
    }
    assert_eq!(compared, 60);

    // Errors of the curve as the file has them.
    let error = rows(&out.join("errors.csv"))
        .into_iter()
        .find(|r| {
            let keys = ["case", "method", "body", "curve", "quantity"];
            keys.map(|k| r[k].as_str()) == [case, "mirror", "block", "depth-0.9", "sigma_yy"]
        })
        .expect("the row of the curve");
    for (column, cell) in [("max", 3), ("rms", 4), ("l1", 5)] {
        let cell = format!(
            "document.querySelector('#readout tr[data-source=\"mirror\"]').cells[{cell}].textContent"
        );
        assert!((shown(&page.text(&cell)) - number(&error, column)).abs() < 6e-5, "{column}");
    }

    // Zoom, units, differences, and a source that is hidden.
    let ticks = "[...document.querySelectorAll('#chart text')].map((t) => t.textContent).join()";
    let all = page.text(ticks);
    page.press("+");
    assert_ne!(page.text(ticks), all, "zoom changes the axes");
    page.press("0");
    assert_eq!(page.text(ticks), all, "and 0 shows all again");
    page.choose("units", "si");
    assert!(page.text(ticks).contains("z (mm)") && page.text(ticks).contains("σyy (MPa)"));
    page.choose("show", "difference");
    assert!(page.text(ticks).contains("difference to FEM"));
    page.eval("document.querySelector('#readout tr[data-source=\"mirror\"] input').click()");
    let mirror = "document.querySelector('#chart path[data-source=\"mirror\"]') === null";
    assert_eq!(page.eval(mirror), json!(true));
    assert!(page.text("location.hash").contains("curve=depth-0.9"), "a link to this view");

    // A case without FEM is shown all the same.
    page.choose("case", "w1e-3_sl6_lr1");
    assert!(page.text("document.querySelector('#not-done').innerText").contains("w1e-3_sl6_lr1"));

    // Readable at two widths in both schemes: nothing exceeds the window.
    page.choose("case", case);
    page.choose("show", "value");
    let pictures = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    for (width, height) in [(1280, 900), (390, 844)] {
        page.resize(width, height);
        let fits = "document.getElementById('chart').clientWidth <= innerWidth";
        page.wait(fits);
        let overflow = "document.documentElement.scrollWidth <= innerWidth";
        assert_eq!(page.eval(overflow), json!(true), "the page is wider than {width} px");
        let controls = "[...document.querySelectorAll('.controls > *, #chart, .verdict')].every(\
                        (e) => e.getBoundingClientRect().right <= innerWidth)";
        assert_eq!(page.eval(controls), json!(true), "a control sticks out at {width} px");
        // What scrolls sideways can be reached by keyboard.
        let reachable = "[...document.querySelectorAll('.wide, figure')].every(\
                         (e) => e.scrollWidth <= e.clientWidth || e.tabIndex === 0)";
        page.wait(reachable);
        for scheme in ["light", "dark"] {
            page.scheme(scheme);
            let background = page.text("getComputedStyle(document.body).backgroundColor");
            assert_eq!(background == "rgb(255, 255, 255)", scheme == "light", "{background}");
            let name = format!("page-{width}-{scheme}.png");
            assert_eq!(page.picture(&pictures.join(name)), (width, height));
        }
    }

    // On paper there are no controls, and text states their choices.
    page.call("Emulation.setEmulatedMedia", json!({ "media": "print" }));
    let display = |id: &str| format!("getComputedStyle(document.querySelector('{id}')).display");
    assert_eq!(page.text(&display(".controls")), "none");
    assert_eq!(page.text(&display("#shown")), "block");
    let shown = page.text("document.getElementById('shown').textContent");
    assert!(shown.contains(case) && shown.contains("block, depth-0.9"), "{shown}");
    assert_eq!(page.text("document.getElementById('chart').getAttribute('aria-label')"), shown);
    assert_eq!(page.complaints(), Vec::<String>::new());
}
