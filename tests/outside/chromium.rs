//! A page in real headless Chromium, driven through its debugging pipe.
//!
//! Tests of pages are skipped with a message where Chromium is not installed, unless
//! `EDGELINE_REQUIRE_BROWSER` is set; `tests/all.sh` installs it and sets that.

use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(60);

/// Whether the page is there and, if it has scripts, they have said so.
const READY: &str = "location.href !== 'about:blank' && document.readyState === 'complete' && \
     (!document.scripts.length || document.documentElement.dataset.ready === 'yes')";

/// A page in its own browser.
pub struct Page {
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

/// The browser; without one the test is skipped, unless it is required.
pub fn browser() -> Option<PathBuf> {
    let found = chromium();
    if found.is_none() {
        let required = std::env::var_os("EDGELINE_REQUIRE_BROWSER").is_some();
        assert!(!required, "Chromium is not on the PATH");
        eprintln!("skipped: Chromium is not on the PATH");
    }
    found
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
    /// Opens a file.
    pub fn open(program: &Path, file: &Path) -> Self {
        Self::visit(program, &format!("file://{}", file.canonicalize().unwrap().display()))
    }

    /// Opens a link, and waits until the page is ready.
    pub fn visit(program: &Path, url: &str) -> Self {
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
        page.call("Page.navigate", json!({ "url": url }));
        page.wait(READY);
        page
    }

    /// Calls a method of the protocol and returns its result; events on the way are kept.
    pub fn call(&mut self, method: &str, params: Value) -> Value {
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
    pub fn eval(&mut self, expression: &str) -> Value {
        let arguments =
            json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let result = self.call("Runtime.evaluate", arguments);
        assert!(result.get("exceptionDetails").is_none(), "{expression}: {result}");
        result["result"]["value"].clone()
    }

    pub fn text(&mut self, expression: &str) -> String {
        self.eval(expression).as_str().unwrap_or_default().to_string()
    }

    pub fn wait(&mut self, condition: &str) {
        let began = Instant::now();
        while self.eval(condition) != json!(true) {
            assert!(began.elapsed() < PATIENCE, "waited in vain for {condition}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    pub fn resize(&mut self, width: u32, height: u32) {
        let mobile = width < 600;
        let size =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile });
        self.call("Emulation.setDeviceMetricsOverride", size);
    }

    pub fn scheme(&mut self, scheme: &str) {
        let features = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
        self.call("Emulation.setEmulatedMedia", features);
    }

    pub fn press(&mut self, key: &str) {
        // Sliders look at the code, as of a keyboard.
        let codes = [("ArrowLeft", 37), ("ArrowRight", 39), ("Home", 36), ("End", 35)];
        let code = codes.iter().find(|(name, _)| *name == key).map_or(0, |(_, code)| *code);
        for kind in ["keyDown", "keyUp"] {
            let event =
                json!({ "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", event);
        }
    }

    /// Chooses a value of a select as a user does.
    pub fn choose(&mut self, id: &str, value: &str) {
        let script = format!(
            "(() => {{ const s = document.getElementById('{id}'); s.value = '{value}'; \
             s.dispatchEvent(new Event('change', {{ bubbles: true }})); return s.value; }})()"
        );
        assert_eq!(self.text(&script), value, "{id} offers {value}");
    }

    /// Saves a picture of the window and returns its size.
    pub fn picture(&mut self, path: &Path) -> (u32, u32) {
        let shot = self.call("Page.captureScreenshot", json!({ "format": "png" }));
        let png = base64(shot["data"].as_str().unwrap());
        std::fs::write(path, &png).unwrap();
        assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
        let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
        (number(16), number(20))
    }

    /// Errors of the page, and its requests to others than `own`.
    pub fn complaints(&mut self, own: &str) -> Vec<String> {
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
                        let here =
                            [own, "data:", "blob:"].iter().any(|start| url.starts_with(start));
                        (!here).then(|| format!("asked for {url}"))
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
