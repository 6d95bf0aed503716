//! `edgeline explore`: who is answered, and what ends it. The page itself is tested in
//! `tests/outside/`.

use crate::support::{Explorer, edgeline, files, kill, refused};
use serde_json::Value;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::os::unix::process::ExitStatusExt;
use std::time::{Duration, Instant};

/// An answer: its status, its head and its body.
struct Answer {
    status: u16,
    head: String,
    body: String,
}

impl Answer {
    fn json(&self) -> Value {
        serde_json::from_str(&self.body).unwrap_or_else(|e| panic!("{e}: {}", self.body))
    }
}

/// Sends the bytes of a request on a connection of its own, and reads until the server closes it.
fn send(port: u16, bytes: &[u8]) -> Answer {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    // A server that has seen enough may close before all is sent.
    let _ = stream.write_all(bytes);
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    let text = String::from_utf8_lossy(&answer);
    let (head, body) = text.split_once("\r\n\r\n").unwrap_or((&text, ""));
    let status = head.split(' ').nth(1).and_then(|s| s.parse().ok()).unwrap_or(0);
    Answer { status, head: head.to_lowercase(), body: body.to_string() }
}

/// A request of one of its pages, with more `headers`.
fn ask(explorer: &Explorer, method: &str, path: &str, headers: &str, body: &str) -> Answer {
    let (port, token) = (explorer.port, &explorer.token);
    let host = if headers.contains("Host:") {
        String::new()
    } else {
        format!("Host: 127.0.0.1:{port}\r\n")
    };
    let length = body.len();
    let request = format!(
        "{method} /{token}/{path} HTTP/1.1\r\n{host}{headers}Connection: close\r\nContent-Length: {length}\r\n\r\n{body}"
    );
    send(port, request.as_bytes())
}

const CASE: &str = "name = 'a'\nroller = { radius_m = 10e-3, young_pa = 210e9, poisson = 0.3 }\n\
                    block = { young_pa = 210e9, poisson = 0.3 }\n\
                    dimensionless = { W = 5e-4, S_l = 5.0, L_r = 1.0 }\naccuracy = { tolerance = 5e-3 }\n";

#[test]
fn only_the_page_of_the_link_is_answered() {
    let folder = tempfile::tempdir().unwrap();
    let explorer = Explorer::start(folder.path(), &["flush-short"]);
    let port = explorer.port;
    // The loopback interface alone.
    let listening = std::fs::read_to_string("/proc/net/tcp").unwrap()
        + &std::fs::read_to_string("/proc/net/tcp6").unwrap_or_default();
    let own: Vec<&str> = listening
        .lines()
        .filter_map(|line| line.split_whitespace().nth(1).filter(|_| line.contains(" 0A ")))
        .filter(|at| at.ends_with(&format!(":{port:04X}")))
        .collect();
    assert_eq!(own, [format!("0100007F:{port:04X}")]);

    assert_eq!(explorer.link, format!("http://127.0.0.1:{port}/{}/", explorer.token));
    let page = ask(&explorer, "GET", "", "", "");
    assert_eq!(page.status, 200);
    for header in
        ["default-src 'none'", "frame-ancestors 'none'", "nosniff", "no-referrer", "no-store"]
    {
        assert!(page.head.contains(header), "{header}: {}", page.head);
    }
    assert!(page.body.contains("<title>edgeline explore</title>"));
    for (name, kind) in [
        ("page.js", "javascript"),
        ("charts.js", "javascript"),
        ("page.css", "css"),
        ("start.json", "json"),
    ] {
        let answer = ask(&explorer, "GET", name, "", "");
        assert!(answer.status == 200 && answer.head.contains(kind), "{name}: {}", answer.head);
        let plain = answer.body.replace("http://www.w3.org/2000/svg", "");
        assert!(!plain.contains("://"), "{name} asks others");
    }
    assert!(!page.body.contains("://"));

    // Without the secret word there is nothing.
    let other = "0".repeat(32);
    for path in [
        "/".into(),
        format!("/{other}/"),
        format!("/{}", &explorer.token[..31]),
        "/../../etc/passwd".into(),
    ] {
        let request =
            format!("GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n\r\n");
        assert_eq!(send(port, request.as_bytes()).status, 404, "{path}");
    }
    assert_eq!(ask(&explorer, "GET", "../page.js", "", "").status, 404);

    // Another name of this host, as DNS rebinding gives it, and pages of others.
    for host in [
        "Host: evil.example\r\n".to_string(),
        format!("Host: evil.example:{port}\r\n"),
        "Host: 127.0.0.1\r\n".into(),
    ] {
        assert_eq!(ask(&explorer, "GET", "", &host, "").status, 403, "{host}");
    }
    for origin in ["http://evil.example", "null", "https://127.0.0.1"] {
        let headers = format!("Origin: {origin}\r\n");
        assert_eq!(ask(&explorer, "POST", "solve", &headers, CASE).status, 403, "{origin}");
    }
    let origin = format!("Origin: http://127.0.0.1:{port}\r\n");
    assert_eq!(ask(&explorer, "POST", "solve", &origin, CASE).status, 200);

    // Other methods, and what is not HTTP.
    assert_eq!(ask(&explorer, "GET", "solve", "", "").status, 405);
    assert_eq!(ask(&explorer, "DELETE", "", "", "").status, 405);
    assert!(
        send(port, b"\x16\x03\x01\x02\x00\x01\x00\r\n\r\n").status >= 400
            || send(port, b"\x00\r\n\r\n").status != 200
    );
    assert_eq!(files(folder.path()), Vec::<String>::new(), "nothing is written");
}

#[test]
fn sizes_and_rates_are_limited() {
    let folder = tempfile::tempdir().unwrap();
    let explorer = Explorer::start(folder.path(), &[]);
    let large = " ".repeat(300 << 10);
    assert_eq!(ask(&explorer, "POST", "solve", "", &large).status, 413);
    // Said without the length, too.
    let chunked = format!(
        "POST /{}/solve HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\nTransfer-Encoding: chunked\r\n\r\n{:x}\r\n{large}\r\n0\r\n\r\n",
        explorer.token,
        explorer.port,
        large.len()
    );
    assert_eq!(send(explorer.port, chunked.as_bytes()).status, 413);
    let head = format!("X-Long: {}\r\n", "a".repeat(64 << 10));
    assert_eq!(ask(&explorer, "GET", "", &head, "").status, 431);
    let many: String = (0..300).map(|i| format!("X-{i}: a\r\n")).collect();
    assert_eq!(ask(&explorer, "GET", "", &many, "").status, 431);
    assert_eq!(ask(&explorer, "GET", "", "", "").status, 200, "it goes on");

    // Many requests on one connection.
    let one = format!(
        "GET /{}/page.css HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n",
        explorer.token, explorer.port
    );
    let last = one.replace("\r\n\r\n", "\r\nConnection: close\r\n\r\n");
    let answers = |requests: &str, status: &str| -> usize {
        let mut stream = TcpStream::connect(("127.0.0.1", explorer.port)).unwrap();
        let mut reader = stream.try_clone().unwrap();
        let answers = std::thread::spawn(move || {
            let mut all = Vec::new();
            let _ = reader.read_to_end(&mut all);
            String::from_utf8_lossy(&all).into_owned()
        });
        stream.write_all(requests.as_bytes()).unwrap();
        answers.join().unwrap().matches(&format!("HTTP/1.1 {status}")).count()
    };
    // Those that do not know the link take nothing from what is allowed.
    let strange = one.replace(&explorer.token, "nothing").repeat(2000);
    assert_eq!(answers(&(strange + &last), "200"), 1);
    let refused = answers(&(one.repeat(2000) + &last), "429");
    assert!((100..=1600).contains(&refused), "{refused} of 2001 refused");
    std::thread::sleep(Duration::from_millis(500));
    assert_eq!(ask(&explorer, "GET", "", "", "").status, 200, "it goes on");
}

#[test]
fn bad_cases_get_the_message_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let explorer = Explorer::start(folder.path(), &[]);
    for (from, to) in [
        ("10e-3", "-1.0"),
        ("0.3", "0.7"),
        ("S_l", "S_1"),
        ("name = 'a'", "name = '../a'"),
        ("210e9", "'steel'"),
        ("name =", "nmae ="),
    ] {
        let text = CASE.replacen(from, to, 1);
        std::fs::write(folder.path().join("bad.toml"), &text).unwrap();
        let said = refused(&mut edgeline(folder.path(), &["solve", "bad.toml", "--out", "o"]));
        let message = said.trim().strip_prefix("error: bad.toml").unwrap();
        let answer = ask(&explorer, "POST", "solve", "Content-Type: application/toml\r\n", &text);
        assert_eq!(answer.status, 200);
        assert!(answer.head.contains("x-edgeline-refused: case"), "{}", answer.head);
        assert_eq!(answer.json()["error"], format!("the case{message}"));
    }
    std::fs::remove_file(folder.path().join("bad.toml")).unwrap();
    for (body, wanted) in [("[1, 2]", "not a case"), ("{\"name\": ", "JSON"), ("{}", "no load")] {
        let answer = ask(&explorer, "POST", "solve", "Content-Type: application/json\r\n", body);
        assert!(answer.json()["error"].as_str().unwrap().contains(wanted), "{}", answer.body);
    }
    // No request makes the program open a file.
    let file = CASE.replace(
        "poisson = 0.3 }\nblock",
        "poisson = 0.3, profile = { kind = 'table', file = '/etc/passwd' } }\nblock",
    );
    let said =
        ask(&explorer, "POST", "solve", "", &file).json()["error"].as_str().unwrap().to_string();
    assert!(said.contains("opens no files") && !said.contains("root"), "{said}");
    for query in ["method=quarter", "coarser=7", "state=x", "what=1", "file=../x"] {
        let path = format!("file?{query}");
        assert_eq!(ask(&explorer, "POST", &path, "", CASE).status, 400, "{query}");
    }
    assert_eq!(files(folder.path()), Vec::<String>::new());
}

#[test]
fn a_newer_state_replaces_a_solve_in_flight() {
    let folder = tempfile::tempdir().unwrap();
    let explorer = Explorer::start(folder.path(), &[]);
    // Some seconds of work.
    let slow = CASE
        .replace("S_l = 5.0", "S_l = 60.0")
        .replace("tolerance = 5e-3", "tolerance = 1e-5")
        .replace("block =", "pose = { tilt_rad = 2e-4 }\nblock =");
    let began = Instant::now();
    let (first, newer) = std::thread::scope(|scope| {
        let first = scope.spawn(|| ask(&explorer, "POST", "solve?page=a&state=1", "", &slow));
        std::thread::sleep(Duration::from_millis(300));
        let newer = ask(&explorer, "POST", "solve?page=a&state=2", "", CASE);
        (first.join().unwrap(), newer)
    });
    assert!(first.head.contains("x-edgeline-refused: replaced"), "{} {}", first.head, first.body);
    assert!(newer.json()["summary"]["converged"].as_bool().unwrap());
    let taken = began.elapsed();
    // So does a client that breaks off.
    let request = format!(
        "POST /{}/solve HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nContent-Length: {}\r\n\r\n{slow}",
        explorer.token,
        explorer.port,
        slow.len()
    );
    let mut stream = TcpStream::connect(("127.0.0.1", explorer.port)).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    std::thread::sleep(Duration::from_millis(300));
    drop(stream);
    let began = Instant::now();
    assert_eq!(ask(&explorer, "POST", "solve?page=b&state=1", "", CASE).status, 200);
    eprintln!("replaced after {taken:?}, broken off after {:?}", began.elapsed());
}

#[test]
fn files_are_those_that_solve_writes() {
    let folder = tempfile::tempdir().unwrap();
    let explorer = Explorer::start(folder.path(), &[]);
    let out = tempfile::tempdir().unwrap();
    std::fs::write(out.path().join("a.toml"), CASE).unwrap();
    let arguments = ["solve", "a.toml", "--method", "guilbault", "--out", "o"];
    assert!(edgeline(out.path(), &arguments).output().unwrap().status.success());
    for name in ["curves.csv", "pressure.csv", "line_load.csv"] {
        let answer =
            ask(&explorer, "POST", &format!("file?method=guilbault&file={name}"), "", CASE);
        let written = std::fs::read_to_string(out.path().join("o").join(name)).unwrap();
        assert!(answer.body == written, "{name}");
    }
    let toml = ask(&explorer, "POST", "file?file=case.toml", "", CASE).body;
    let case = |text: &str| edgeline::case::Case::from_toml(text).unwrap();
    assert!(case(&toml).is_same_problem(&case(CASE)));
    let page = ask(&explorer, "POST", "file?file=summary.html", "", CASE);
    assert!(page.body.contains("<svg") && page.head.contains("text/html"));
}

#[test]
fn a_closed_page_and_ctrl_c_end_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut explorer = Explorer::start(folder.path(), &[]);
    let open = |explorer: &Explorer| {
        let mut stream = TcpStream::connect(("127.0.0.1", explorer.port)).unwrap();
        let request = format!(
            "GET /{}/alive HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n",
            explorer.token, explorer.port
        );
        stream.write_all(request.as_bytes()).unwrap();
        let mut start = [0; 15];
        stream.read_exact(&mut start).unwrap();
        assert_eq!(&start, b"HTTP/1.1 200 OK");
        stream
    };
    // A page that is loaded again is not closed.
    let page = open(&explorer);
    drop(page);
    std::thread::sleep(Duration::from_millis(300));
    let page = open(&explorer);
    std::thread::sleep(Duration::from_secs(4));
    assert!(explorer.child.try_wait().unwrap().is_none(), "the page is open");
    drop(page);
    let status = explorer.ended();
    assert!(status.success(), "{status}");
    let explorer = Explorer::start(folder.path(), &[]);
    kill(explorer.child.id() as i32, libc::SIGINT);
    let port = explorer.port;
    let mut explorer = explorer;
    assert_eq!(explorer.ended().signal(), Some(libc::SIGINT));
    assert!(TcpStream::connect(("127.0.0.1", port)).is_err());
    assert_eq!(files(folder.path()), Vec::<String>::new());
}

#[test]
fn a_taken_port_and_a_bad_case_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let explorer = Explorer::start(folder.path(), &[]);
    let port = explorer.port.to_string();
    let said = refused(&mut edgeline(folder.path(), &["explore", "--port", &port]));
    let wanted = format!("--port = {port} is not valid: Address already in use");
    assert!(said.contains(&wanted) && said.contains("leave it out for any free one"), "{said}");
    assert!(
        refused(&mut edgeline(folder.path(), &["explore", "nowhere.toml"]))
            .contains("built-in case")
    );
}
