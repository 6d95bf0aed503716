//! The server of the explorer: who is answered, and what.
//!
//! It listens on the loopback interface alone. Every path begins with a secret word, so that no
//! other program or page can guess one; requests to another host's name (DNS rebinding) or from
//! another origin are refused. Sizes, rates, connections and times are limited. It writes no file.

use super::alive::{Alive, Pages};
use super::answer::solved;
use super::asked;
use super::controls::controls;
use super::desk::{Desk, Refusal, Task, Turn};
use super::files::{FILES, kind_of, made};
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::host::secret;
use http_body_util::combinators::BoxBody;
use http_body_util::{BodyExt, Full, Limited};
use hyper::body::{Bytes, Incoming};
use hyper::header::{CONTENT_TYPE, HOST, HeaderName, HeaderValue, ORIGIN};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use std::convert::Infallible;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

/// Largest request (bytes): its head, and its body.
const MOST_HEAD: usize = 16 << 10;
const MOST_BODY: usize = 256 << 10;

/// Most connections at a time; further ones wait.
const MOST_CONNECTIONS: usize = 32;

/// Most requests a second, and how many may come at once after a pause.
const RATE: f64 = 250.0;
const BURST: f64 = 500.0;

/// How long a client may take for its head or its body.
const SLOW: Duration = Duration::from_secs(10);

/// How long a case may be solved.
const LONGEST_SOLVE: Duration = Duration::from_secs(60);

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
const CHARTS: &str = include_str!("charts.js");

/// What every answer says to the browser: no other source of anything, no frame, no sniffing, no
/// cache, no word about the link to others.
const HEADERS: [(&str, &str); 7] = [
    (
        "content-security-policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data: blob:; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    ("x-content-type-options", "nosniff"),
    ("referrer-policy", "no-referrer"),
    ("cache-control", "no-store"),
    ("cross-origin-opener-policy", "same-origin"),
    ("cross-origin-resource-policy", "same-origin"),
    ("x-frame-options", "DENY"),
];

/// The header that says why there is no solution.
const REFUSED: HeaderName = HeaderName::from_static("x-edgeline-refused");

type Answer = Response<BoxBody<Bytes, Infallible>>;

/// An explorer that listens but does not answer yet.
pub struct Explorer {
    runtime: tokio::runtime::Runtime,
    listener: TcpListener,
    address: SocketAddr,
    token: String,
    case: Case,
}

/// Takes a port of the loopback interface, any free one for 0, for a page that begins with `case`.
///
/// # Errors
/// [`Error::Value`] when the port cannot be had, [`Error::Io`] when the system has none.
pub fn serve(case: Case, port: u16) -> Result<Explorer> {
    let io = |source| Error::Io {
        action: "listen at",
        path: format!("127.0.0.1:{port}").into(),
        source,
    };
    let refused = |source: std::io::Error| match port {
        0 => io(source),
        _ => Error::Value {
            key: "--port".into(),
            value: port.to_string(),
            reason: source.to_string(),
            remedy: "give another one, or leave it out for any free one".into(),
        },
    };
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_io()
        .enable_time()
        .build()
        .map_err(io)?;
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    let listener = runtime.block_on(TcpListener::bind(address)).map_err(refused)?;
    let address = listener.local_addr().map_err(io)?;
    Ok(Explorer { runtime, listener, address, token: secret()?, case })
}

impl Explorer {
    /// The page's link.
    pub fn link(&self) -> String {
        format!("http://{}/{}/", self.address, self.token)
    }

    /// Answers until the last page has been closed.
    pub fn run(self) {
        let Self { runtime, listener, address, token, case } = self;
        let names = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", address.port()));
        let house = Arc::new(House {
            names,
            token,
            start: controls(&case).to_string(),
            case,
            desk: Desk::open(),
            pages: Pages::default(),
            allowance: Mutex::new((BURST, Instant::now())),
        });
        runtime.block_on(async {
            tokio::spawn(accept(listener, house.clone()));
            house.pages.all_closed().await;
        });
        house.desk.close();
    }
}

/// Takes connections, a limited number at a time.
async fn accept(listener: TcpListener, house: Arc<House>) {
    let places = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    loop {
        let place = places.clone().acquire_owned().await;
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            // For example too many open files: others may close some.
            Err(_) => {
                tokio::time::sleep(Duration::from_millis(100)).await;
                continue;
            }
        };
        // A page waits for small answers.
        let _ = stream.set_nodelay(true);
        let house = house.clone();
        tokio::spawn(async move {
            let _place = place;
            let service = service_fn(move |request| {
                let house = house.clone();
                async move { Ok::<_, Infallible>(house.answer(request).await) }
            });
            // A client that breaks off or does not speak HTTP is no business of others.
            let _ = http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(SLOW)
                .max_buf_size(MOST_HEAD)
                .serve_connection(TokioIo::new(stream), service)
                .await;
        });
    }
}

/// What all answers share.
struct House {
    /// The names by which the page may call this host.
    names: [String; 2],
    token: String,
    /// The page's fields, as JSON.
    start: String,
    /// The case that the explorer was started with.
    case: Case,
    desk: Desk,
    pages: Pages,
    /// How many more requests are answered now, and when that was counted.
    allowance: Mutex<(f64, Instant)>,
}

/// An answer that refuses a request.
struct No(StatusCode, String);

impl House {
    async fn answer(&self, request: Request<Incoming>) -> Answer {
        let mut answer = match self.checked(request).await {
            Ok(answer) => answer,
            Err(No(status, message)) => {
                let body = serde_json::json!({ "error": message }).to_string();
                let mut answer = whole("application/json", body);
                *answer.status_mut() = status;
                answer
            }
        };
        for (name, value) in HEADERS {
            let name = HeaderName::from_static(name);
            answer.headers_mut().insert(name, HeaderValue::from_static(value));
        }
        answer
    }

    /// Answers a request of the page itself; any other one is refused before its body is read.
    async fn checked(&self, request: Request<Incoming>) -> std::result::Result<Answer, No> {
        let header =
            |name| request.headers().get(name).and_then(|value: &HeaderValue| value.to_str().ok());
        if !header(HOST).is_some_and(|host| self.names.iter().any(|name| name == host)) {
            return Err(No(StatusCode::FORBIDDEN, "this is not the host that you ask for".into()));
        }
        let own = |origin: &str| {
            origin
                .strip_prefix("http://")
                .is_some_and(|host| self.names.iter().any(|name| name == host))
        };
        if request.headers().contains_key(ORIGIN) && !header(ORIGIN).is_some_and(own) {
            return Err(No(StatusCode::FORBIDDEN, "other pages are not answered".into()));
        }
        let nothing = || {
            No(
                StatusCode::NOT_FOUND,
                "there is nothing here: take the link that the program printed".into(),
            )
        };
        let path = request.uri().path().to_string();
        let (token, name) = path.trim_start_matches('/').split_once('/').ok_or_else(nothing)?;
        if !same(token, &self.token) {
            return Err(nothing());
        }
        // Only what knows the link counts: other pages could use up what this one is allowed.
        self.charge()?;
        match (request.method(), name) {
            (&Method::GET, "") => Ok(whole("text/html; charset=utf-8", PAGE)),
            (&Method::GET, "page.css") => Ok(whole("text/css; charset=utf-8", STYLE)),
            (&Method::GET, "page.js") => Ok(whole("text/javascript; charset=utf-8", SCRIPT)),
            (&Method::GET, "charts.js") => Ok(whole("text/javascript; charset=utf-8", CHARTS)),
            (&Method::GET, "start.json") => Ok(whole("application/json", self.start.clone())),
            (&Method::GET, "alive") => Ok(self.alive()),
            (&Method::POST, "solve" | "file") => self.solve(request).await,
            (
                _,
                "" | "page.css" | "page.js" | "charts.js" | "start.json" | "alive" | "solve"
                | "file",
            ) => Err(No(StatusCode::METHOD_NOT_ALLOWED, "this is asked for in another way".into())),
            _ => Err(nothing()),
        }
    }

    /// Counts a request.
    fn charge(&self) -> std::result::Result<(), No> {
        let mut allowance = self.allowance.lock().unwrap_or_else(|e| e.into_inner());
        let (left, counted) = *allowance;
        let now = Instant::now();
        let left = (left + RATE * now.duration_since(counted).as_secs_f64()).min(BURST);
        *allowance = ((left - 1.0).max(0.0), now);
        if left >= 1.0 {
            return Ok(());
        }
        Err(No(StatusCode::TOO_MANY_REQUESTS, "too many requests a second".into()))
    }

    fn alive(&self) -> Answer {
        let body: Alive = self.pages.opened();
        typed("text/event-stream", body.boxed())
    }

    /// Solves the case in the request's body.
    async fn solve(&self, request: Request<Incoming>) -> std::result::Result<Answer, No> {
        let bad = |message: String| No(StatusCode::BAD_REQUEST, message);
        let asked = Asked::of(request.uri().query().unwrap_or("")).map_err(bad)?;
        let for_file = request.uri().path().ends_with("/file");
        if for_file && !asked.file.as_deref().is_some_and(|file| FILES.contains(&file)) {
            return Err(bad(format!("file: there are {}", FILES.join(", "))));
        }
        let is_json = request
            .headers()
            .get(CONTENT_TYPE)
            .is_some_and(|kind| kind.as_bytes().starts_with(b"application/json"));
        let body = Limited::new(request.into_body(), MOST_BODY).collect();
        let body = match tokio::time::timeout(SLOW, body).await {
            Err(_) => {
                return Err(No(StatusCode::REQUEST_TIMEOUT, "the case did not arrive".into()));
            }
            Ok(Err(e)) if e.is::<http_body_util::LengthLimitError>() => {
                let message = format!("a case has at most {MOST_BODY} bytes here");
                return Err(No(StatusCode::PAYLOAD_TOO_LARGE, message));
            }
            Ok(Err(_)) => return Err(bad("the case did not arrive whole".into())),
            Ok(Ok(body)) => body.to_bytes(),
        };
        let case = match asked::case(&body, is_json, &self.case) {
            Ok(case) => case,
            Err(e) => return Ok(without_solution("case", &e.to_string())),
        };
        let (method, coarser, file) = (asked.method, asked.coarser, asked.file);
        let kind = file.as_deref().map_or("application/json", kind_of);
        let task: Task = match file.filter(|_| for_file) {
            Some(file) => Box::new(move || made(&case, method, &file)),
            None => Box::new(move || solved(&case, method, coarser)),
        };
        let pending = match self.desk.ask(asked.turn, task) {
            Ok(pending) => pending,
            Err(refusal) => return Ok(refused(refusal)),
        };
        Ok(match tokio::time::timeout(LONGEST_SOLVE, pending.answer()).await {
            Ok(Ok(found)) => whole(kind, found),
            Ok(Err(refusal)) => refused(refusal),
            Err(_) => {
                let message = format!(
                    "this takes longer than {} s; use a coarser tolerance, or `edgeline solve`",
                    LONGEST_SOLVE.as_secs()
                );
                without_solution("slow", &message)
            }
        })
    }
}

/// Whether two words are equal, in a time that does not tell where they differ.
fn same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |all, (a, b)| all | (a ^ b)) == 0
}

fn refused(refusal: Refusal) -> Answer {
    match refusal {
        Refusal::Replaced => without_solution("replaced", "a newer state has been asked for"),
        Refusal::Busy => without_solution("busy", "too many cases wait"),
        Refusal::Failed(message) => without_solution("case", &message),
        Refusal::Fault => {
            without_solution("fault", "a fault of the program; its terminal says more")
        }
    }
}

/// The answer to a well-formed request whose case has no solution. To HTTP it is a success: a
/// browser would put anything else on its console as an error of the page.
fn without_solution(reason: &'static str, message: &str) -> Answer {
    let mut answer = whole("application/json", serde_json::json!({ "error": message }).to_string());
    answer.headers_mut().insert(REFUSED, HeaderValue::from_static(reason));
    answer
}

/// What the query of a request says.
struct Asked {
    method: EdgeModel,
    turn: Turn,
    /// At least this tolerance, and few curves: while a slider moves.
    coarser: Option<f64>,
    file: Option<String>,
}

impl Asked {
    /// Reads a query: its values are plain words and numbers.
    fn of(query: &str) -> std::result::Result<Self, String> {
        let turn = Turn { page: String::new(), state: 0 };
        let mut asked = Self { method: EdgeModel::QuarterSpace, turn, coarser: None, file: None };
        for (name, value) in query.split('&').filter_map(|pair| pair.split_once('=')) {
            let bad = || format!("{name} = {value} is not valid");
            match name {
                "method" => {
                    let all = EdgeModel::ALL.into_iter();
                    asked.method = all.clone().find(|m| m.name() == value).ok_or_else(|| {
                        format!(
                            "{}; there are {}",
                            bad(),
                            all.map(EdgeModel::name).collect::<Vec<_>>().join(", ")
                        )
                    })?;
                }
                "page" if value.len() <= 64 => asked.turn.page = value.into(),
                "state" => asked.turn.state = value.parse().map_err(|_| bad())?,
                "coarser" => {
                    let least: f64 = value.parse().map_err(|_| bad())?;
                    asked.coarser = Some(least).filter(|v| (1e-5..=1e-1).contains(v));
                    asked.coarser.ok_or_else(bad)?;
                }
                "file" => asked.file = Some(value.into()),
                _ => return Err(bad()),
            }
        }
        Ok(asked)
    }
}

fn whole(kind: &'static str, body: impl Into<Bytes>) -> Answer {
    typed(kind, Full::new(body.into()).boxed())
}

fn typed(kind: &'static str, body: BoxBody<Bytes, Infallible>) -> Answer {
    let mut answer = Response::new(body);
    answer.headers_mut().insert(CONTENT_TYPE, HeaderValue::from_static(kind));
    answer
}
