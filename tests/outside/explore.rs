//! The explorer in a real browser: its fields, its numbers and its pace.

use crate::chromium::{Page, browser};
use crate::support::{Explorer, edgeline, number, rows, succeeded};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A case at the tolerance of sliders.
const CASE: &str = "name = \"own\"\n[roller]\nradius_m = 10e-3\nlength_m = 3e-3\nyoung_pa = 210e9\npoisson = 0.3\n\
                    [block]\nlength_m = 6e-3\nyoung_pa = 200e9\npoisson = 0.28\n[load]\nforce_n = 1500.0\n\
                    [accuracy]\ntolerance = 5e-3\n";

/// The longest a page may take to show what it was asked for.
const PATIENCE: Duration = Duration::from_secs(60);

/// An explorer with its page.
struct Explored {
    page: Page,
    explorer: Explorer,
    folder: tempfile::TempDir,
    browser: PathBuf,
}

impl Explored {
    /// None without a browser.
    fn new() -> Option<Self> {
        let browser = browser()?;
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("own.toml"), CASE).unwrap();
        let explorer = Explorer::start(folder.path(), &["own.toml"]);
        let page = Page::visit(&browser, &explorer.link);
        let mut explored = Self { page, explorer, folder, browser };
        explored.rest();
        Some(explored)
    }

    /// Waits until all models of the newest state are shown.
    fn rest(&mut self) {
        self.page.wait(
            "document.documentElement.dataset.whole === document.documentElement.dataset.state",
        );
    }

    /// Types into the field of a key, in its own unit.
    fn type_in(&mut self, key: &str, text: &str) {
        self.page.eval(&format!(
            "(() => {{ const i = document.getElementById('key-{key}'); i.value = '{text}'; \
             i.dispatchEvent(new Event('change', {{ bubbles: true }})); }})()"
        ));
        self.rest();
    }

    /// Ticks or unticks the box of an optional key.
    fn tick(&mut self, key: &str) {
        self.page.eval(&format!(
            "document.querySelector('input[type=checkbox][data-key=\"{key}\"]').click()"
        ));
        self.rest();
    }

    /// Clicks into the middle of an element with the mouse.
    fn click(&mut self, selector: &str) {
        let middle = self.page.eval(&format!(
            "(() => {{ const e = document.querySelector('{selector}'); \
             e.scrollIntoView({{ block: 'center' }}); const r = e.getBoundingClientRect(); \
             return [r.x + r.width / 2, r.y + r.height / 2]; }})()"
        ));
        for kind in ["mousePressed", "mouseReleased"] {
            let event = json!({ "type": kind, "x": middle[0], "y": middle[1], "button": "left", "clickCount": 1 });
            self.page.call("Input.dispatchMouseEvent", event);
        }
    }

    /// Types over what a field has, does not leave it, and clicks a form of the load.
    fn type_and_click_form(&mut self, key: &str, text: &str, form: &str) {
        self.click(&format!("[id=\"key-{key}\"]"));
        self.page.eval("document.activeElement.select()");
        self.page.call("Input.insertText", json!({ "text": text }));
        self.click(&format!("#form input[value={form}] + span"));
        self.rest();
    }

    fn choose(&mut self, id: &str, value: &str) {
        self.page.choose(id, value);
        self.rest();
    }

    /// The state that the link carries.
    fn state(&mut self) -> Value {
        let text = self.page.text("decodeURIComponent(location.hash.slice(1))");
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}"))
    }

    fn shown(&mut self, value: &str) -> f64 {
        shown(
            &self
                .page
                .text(&format!("document.querySelector('[data-value=\"{value}\"]').textContent")),
        )
    }

    /// What the page downloads as a file, by the program's own answer to the same case.
    fn downloaded(&mut self, file: &str) -> PathBuf {
        let folder = self.folder.path().join("downloads");
        self.page.call(
            "Page.setDownloadBehavior",
            json!({ "behavior": "allow", "downloadPath": folder.display().to_string() }),
        );
        self.page.eval(&format!("document.querySelector('[data-file=\"{file}\"]').click()"));
        let name = if file == "case.toml" { "own.toml".to_string() } else { format!("own-{file}") };
        let path = folder.join(name);
        let until = Instant::now() + PATIENCE;
        while !path.exists() {
            assert!(Instant::now() < until, "{file} was not downloaded");
            std::thread::sleep(Duration::from_millis(20));
        }
        path
    }

    /// Compares the numbers of the page with `edgeline solve` of the case that it downloads.
    fn same_as_solve(&mut self, what: &str) {
        let case = self.downloaded("case.toml");
        let out = self.folder.path().join("out");
        let solve = ["solve", case.to_str().unwrap(), "--json", "--out", out.to_str().unwrap()];
        let output = edgeline(self.folder.path(), &solve).output().unwrap();
        let (text, said) =
            (std::fs::read_to_string(&case).unwrap(), String::from_utf8(output.stderr).unwrap());
        assert!(output.status.success(), "{what}: {said}\n{text}");
        std::fs::remove_file(&case).unwrap();
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
        for (value, wanted) in [
            ("p-centre", summary["p_centre_pa"].as_f64().unwrap() * 1e-6),
            ("p-max", summary["p_max_pa"].as_f64().unwrap() * 1e-6),
            ("critical", summary["critical"]["value_pa"].as_f64().unwrap() * 1e-6),
            ("load", summary["load_n"].as_f64().unwrap()),
            ("approach", summary["approach_m"].as_f64().unwrap() * 1e6),
            ("p0", summary["hertz"]["p0_pa"].as_f64().unwrap() * 1e-6),
        ] {
            let got = self.shown(value);
            // Five digits, four of p0.
            let digits = if value == "p0" { 5e-4 } else { 5e-5 };
            assert!(
                (got - wanted).abs() <= 1.01 * digits * wanted.abs(),
                "{what}, {value}: {got}, not {wanted}"
            );
        }
        let singular = |end: &str| summary["details"][end]["kind"] == "singular";
        let tile = self.page.text("document.querySelector('[data-tile=p-max]').innerText");
        let says_so = tile.contains("grows with the resolution");
        assert_eq!(says_so, singular("edge") || singular("edge_neg"), "{what}: {tile}");
        let tile = self.page.text("document.querySelector('[data-tile=critical]').innerText");
        assert_eq!(tile.contains("0.1 C and more from an end"), says_so, "{what}: {tile}");
    }
}

/// A number as the page shows it.
fn shown(text: &str) -> f64 {
    text.replace('−', "-").parse().unwrap_or_else(|_| panic!("{text:?} is a number"))
}

#[test]
fn every_field_changes_its_key_and_values_are_those_of_solve() {
    let Some(mut it) = Explored::new() else { return };
    it.same_as_solve("the case of the start");
    every_slider_moves_its_key(&mut it);
    it.page.eval("document.querySelector('#form input[value=factors]').click()");
    it.rest();
    assert_eq!(it.state()["form"], "factors");
    every_slider_moves_its_key(&mut it);
    it.same_as_solve("by factors");
    it.page.eval("document.querySelector('#form input[value=load]').click()");
    it.rest();

    // The right stop of a slider is legal.
    for (key, stop) in [("roller.poisson", 0.499), ("block.poisson", 0.499)] {
        it.page.eval(&format!(
            "document.querySelector('input[type=range][data-key=\"{key}\"]').focus()"
        ));
        it.page.press("End");
        it.rest();
        assert_eq!(it.state()["values"][key], stop);
        assert_eq!(it.page.eval("document.getElementById('message').hidden"), json!(true), "{key}");
        it.type_in(key, "0.3");
    }

    // What is on or off.
    let plain = it.shown("p-centre");
    it.tick("accuracy.first_order");
    assert_eq!(it.state()["flags"]["accuracy.first_order"], true);
    assert_ne!(it.shown("p-centre"), plain);
    it.same_as_solve("to first order");

    // Profiles, raceways, offset and tilt.
    for (kind, key) in [
        ("crown", "radius_m"),
        ("logarithmic", "k"),
        ("relief", "straight_m"),
        ("fujiwara", "zm_m"),
    ] {
        it.choose("profile-roller", kind);
        let state = it.state();
        assert_eq!(state["profiles"]["roller"]["kind"], kind);
        assert!(state["values"][format!("roller.profile.{key}")].is_number(), "{kind}: {state}");
        let drawn = it.page.eval("!document.getElementById('chart-profile').hidden");
        assert_eq!(drawn, json!(true));
    }
    it.choose("profile-roller", "crown");
    it.tick("load.eccentricity_m");
    it.type_in("load.eccentricity_m", "0.2");
    it.same_as_solve("crowned and eccentric");
    assert!(
        it.page.text("document.querySelector('[data-tile=approach]').innerText").contains("tilt")
    );
    it.tick("pose.tilt_rad");
    assert!(it.state()["values"]["load.eccentricity_m"].is_null(), "a tilt is held or free");
    it.choose("profile-roller", "");
    it.tick("pose.tilt_rad");
    it.tick("block.radius_m");
    it.type_in("pose.offset_m", "0.5");
    it.same_as_solve("offset on a raceway");

    // What is wrong is said as on the command line, and gone when it is mended.
    it.type_in("roller.radius_m", "-1");
    let said = it.page.text("document.getElementById('message').textContent");
    assert!(said.contains("roller.radius_m") && said.contains("is greater than zero"), "{said}");
    let marked = "document.getElementById('key-roller.radius_m').getAttribute('aria-invalid')";
    assert_eq!(it.page.text(marked), "true");
    it.type_in("roller.radius_m", "");
    let said = it.page.text("document.getElementById('message').textContent");
    assert!(said.starts_with("roller.radius_m = nothing is not a number"), "{said}");
    it.type_in("roller.radius_m", "10");
    assert_eq!(it.page.eval("document.getElementById('message').hidden"), json!(true));

    // A file that is refused is said until the case changes, whatever solutions come after it.
    it.page.eval(
        "(() => { const i = document.getElementById('key-roller.radius_m'); i.value = '11'; \
         i.dispatchEvent(new Event('change')); const d = new DataTransfer(); \
         d.items.add(new File(['nmae = 1'], 'x.toml')); \
         const open = document.getElementById('open'); open.files = d.files; open.dispatchEvent(new Event('change')); })()",
    );
    it.page.wait("!document.getElementById('message').hidden");
    it.rest();
    let said = it.page.text("document.getElementById('message').textContent");
    assert!(said.contains("unknown key nmae; did you mean name?"), "{said}");
    it.type_in("roller.radius_m", "10");
    assert_eq!(it.page.eval("document.getElementById('message').hidden"), json!(true));

    // A link carries the state to another page.
    let (link, before) = (it.page.text("location.href"), it.state());
    let mut other = Page::visit(&it.browser, &link);
    other.wait("document.documentElement.dataset.whole !== undefined");
    let text = other.text("decodeURIComponent(location.hash.slice(1))");
    assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), before);
    drop(other);

    let origin = format!("http://127.0.0.1:{}/", it.explorer.port);
    assert_eq!(it.page.complaints(&origin), Vec::<String>::new());
}

#[test]
fn what_was_given_outlives_another_form_of_the_load() {
    let Some(mut it) = Explored::new() else { return };
    let field = "document.getElementById('key-load.force_n').value";
    let form = "document.querySelector('#form input:checked').value";
    let kept = "!document.getElementById('kept').hidden";
    let refused = "document.getElementById('results').classList.contains('refused')";

    // Typed, or set by a slider, and not answered yet.
    it.type_and_click_form("load.force_n", "4000", "factors");
    assert_eq!((it.page.text(form), it.shown("load")), ("factors".into(), 4000.0));
    it.type_and_click_form("dimensionless.W", "1e-3", "load");
    assert_eq!(it.page.text(form), "load");
    let tile = it.page.text("document.querySelector('[data-tile=load] p').innerText");
    assert!(tile.starts_with("W 0.001,"), "{tile}");
    it.type_in("load.force_n", "2000");
    let moved = it.page.eval(
        "(() => { const s = document.querySelector('input[type=range][data-key=\"load.force_n\"]'); \
         s.value = 0.4; s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change')); \
         const load = Number(document.getElementById('key-load.force_n').value); \
         document.querySelector('#form input[value=factors]').click(); return load; })()",
    );
    it.rest();
    assert_eq!((it.page.text(form), json!(it.shown("load"))), ("factors".into(), moved));
    it.click("#form input[value=load] + span");
    it.rest();

    // What is refused stays with its message, and so does the form.
    for (text, wanted) in [("1e6", "load.force_n = 1000000 is not valid"), ("much", "not a number")]
    {
        it.type_and_click_form("load.force_n", text, "factors");
        assert_eq!((it.page.text(field), it.page.text(form)), (text.into(), "load".into()));
        let said = it.page.text("document.getElementById('message').textContent");
        assert!(said.contains(wanted), "{said}");
        assert_eq!((it.page.eval(kept), it.page.eval(refused)), (json!(true), json!(true)));
        let status = it.page.text("document.getElementById('status').textContent");
        assert!(status.starts_with("Shown is the last case that was solved"), "{status}");
    }
    it.type_and_click_form("load.force_n", "2000", "factors");
    assert_eq!((it.page.text(form), it.shown("load")), ("factors".into(), 2000.0));
    assert_eq!((it.page.eval(kept), it.page.eval(refused)), (json!(false), json!(false)));
}

#[test]
fn a_tolerance_that_is_too_fine_is_noted_as_on_the_command_line() {
    let Some(mut it) = Explored::new() else { return };
    it.type_in("accuracy.tolerance", "1e-5");
    let status = it.page.text("document.getElementById('status').textContent");
    let out = it.folder.path().join("out");
    let solve = ["solve", "own.toml", "--tolerance", "1e-5", "--out", out.to_str().unwrap()];
    let said = edgeline(it.folder.path(), &solve).output().unwrap().stderr;
    let said = String::from_utf8(said).unwrap();
    let note = said.lines().find(|line| line.starts_with("note: the finest")).unwrap();
    assert!(status.ends_with(note), "{status}\n{note}");
}

/// Moves each slider by one step from the keyboard: its key changes, and no other.
fn every_slider_moves_its_key(it: &mut Explored) {
    let sliders = it.page.eval(
        "[...document.querySelectorAll('input[type=range]')].filter(s => !s.disabled && !s.closest('[hidden]') \
         && !s.hidden).map(s => s.dataset.key)",
    );
    let sliders: Vec<String> = serde_json::from_value(sliders).unwrap();
    assert!(sliders.len() >= 9, "{sliders:?}");
    for key in &sliders {
        let before = it.state();
        let slider = format!("document.querySelector('input[type=range][data-key=\"{key}\"]')");
        it.page.eval(&format!("{slider}.closest('details').open = true; {slider}.focus()"));
        let step = if key.ends_with("poisson") || key.ends_with("L_r") {
            "ArrowLeft"
        } else {
            "ArrowRight"
        };
        it.page.press(step);
        it.rest();
        let after = it.state();
        let changed: Vec<&String> = after["values"]
            .as_object()
            .unwrap()
            .iter()
            .filter(|(name, value)| before["values"][*name] != **value)
            .map(|(name, _)| name)
            .collect();
        assert_eq!(changed, [key], "{before} {after}");
        assert_eq!(it.page.eval("document.getElementById('message').hidden"), json!(true), "{key}");
    }
}

#[test]
fn charts_read_out_the_curves_of_solve() {
    let Some(mut it) = Explored::new() else { return };
    let out = it.folder.path().join("out");
    let solve = ["solve", "own.toml", "--out", out.to_str().unwrap()];
    succeeded(&mut edgeline(it.folder.path(), &solve));
    let curves = rows(&out.join("curves.csv"));
    for (body, curve, quantity) in
        [("block", "depth-0.9", "sigma_xx"), ("roller", "depth-end", "tau_max")]
    {
        it.page.choose("body", body);
        it.page.choose("down", curve);
        it.page.choose("quantity", quantity);
        let own: Vec<_> =
            curves.iter().filter(|r| r["body"] == body && r["curve"] == curve).collect();
        it.page.eval("document.querySelector('#chart-stress-down svg').scrollIntoView()");
        it.page.eval("document.querySelector('#chart-stress-down svg').focus()");
        it.page.press("Home");
        for row in own.iter().take(15) {
            let read = |what: &str| {
                format!("document.querySelector('#chart-stress-down .readout {what}').textContent")
            };
            let z = shown(&it.page.text(&read("span b")));
            let value = shown(&it.page.text(&read("[data-read=quarter-space] b")));
            let wanted = [number(row, "z_m") * 1e3, number(row, &format!("{quantity}_pa")) * 1e-6];
            for (got, wanted) in [z, value].into_iter().zip(wanted) {
                assert!(
                    (got - wanted).abs() <= 5.1e-5 * wanted.abs() + 1e-6,
                    "{body} {curve}: {got}, not {wanted}"
                );
            }
            it.page.press("ArrowRight");
        }
    }
    // The other side of a contact that is symmetric has no curves of its own.
    let offered = "[...document.getElementById('down').options].filter((o) => !o.disabled).length";
    assert_eq!(it.page.eval(offered), json!(3));
    it.type_in("pose.offset_m", "0.5");
    assert_eq!(it.page.eval(offered), json!(5));
    it.page.choose("down", "depth-end-neg");
    it.type_in("pose.offset_m", "0");
    let chosen = "document.getElementById('down').value + ' ' + \
                 document.querySelectorAll('#chart-stress-down [data-series]').length";
    assert_eq!(it.page.text(chosen), "depth-end 4");
    // Another unit, another model, a pinned state.
    it.page.choose("units", "c");
    let p0 =
        shown(&it.page.text("document.querySelector('[data-value=\"p-centre\"]').textContent"));
    assert!((0.5..2.0).contains(&p0), "{p0}");
    let mirror = "document.querySelector('#chart-p-along [data-series=mirror]') !== null";
    assert_eq!(it.page.eval(mirror), json!(true));
    it.page.eval("document.querySelector('#legend input[data-model=mirror]').click()");
    assert_eq!(it.page.eval(mirror), json!(false));
    let read_at_the_middle = |it: &mut Explored, series: &str| {
        it.page.eval("document.querySelector('#chart-p-across svg').focus()");
        it.page.press("Home");
        shown(&it.page.text(&format!(
            "document.querySelector('#chart-p-across [data-read={series}] b').textContent"
        )))
    };
    let before = read_at_the_middle(&mut it, "quarter-space");
    it.page.eval("document.getElementById('pin').click()");
    it.type_in("load.force_n", "3000");
    assert_eq!(read_at_the_middle(&mut it, "pinned"), before, "in its own p0");
    let percent = "document.querySelector('[data-tile=p-centre]').innerText.match(/([+\u{2212}][0-9.]+) %/)[1]";
    let (percent, wanted) =
        (shown(&it.page.text(percent)), 100.0 * (it.shown("p-centre") / p0 - 1.0));
    assert!((percent - wanted).abs() < 0.02, "{percent}, not {wanted}");
    let pinned = "document.querySelector('#chart-p-along [data-series=pinned]') !== null";
    assert_eq!(it.page.eval(pinned), json!(true));
    assert!(
        it.page.text("document.getElementById('tiles').innerText").contains("against the pinned")
    );
    let files = it.downloaded("curves.csv");
    assert!(std::fs::read_to_string(files).unwrap().starts_with("body,curve,x_m"));
    let origin = format!("http://127.0.0.1:{}/", it.explorer.port);
    assert_eq!(it.page.complaints(&origin), Vec::<String>::new());
}

/// Charts out of view are drawn when the page rests, and at once when it is printed. In another
/// width than the screen's the colours of the pressure lie on their axes.
fn every_chart_is_drawn_in_the_end_and_on_paper(it: &mut Explored) {
    it.page.eval("scrollTo(0, 0)");
    let late = "Object.values(document.querySelectorAll('.chart')).filter((c) => c.chart.late && !c.hidden).length";
    let redrawn = format!(
        "(() => {{ const u = document.getElementById('units'); u.value = u.value === 'si' ? 'c' : 'si'; \
         u.dispatchEvent(new Event('change')); return {late}; }})()"
    );
    assert_ne!(it.page.eval(&redrawn), json!(0), "nothing is out of view");
    it.page.wait(&format!("{late} === 0"));
    assert_ne!(it.page.eval(&redrawn), json!(0));
    it.page.call("Page.printToPDF", json!({}));
    assert_eq!(it.page.eval(late), json!(0));
    let off = "(() => { const m = document.getElementById('map'); m.style.width = '200px'; \
               const a = m.querySelector('canvas').getBoundingClientRect(); \
               const b = m.querySelector('svg .frame').getBoundingClientRect(); m.style.width = ''; \
               return Math.max(...['left', 'right', 'top', 'bottom'].map((k) => Math.abs(a[k] - b[k]))); })()";
    assert!(it.page.eval(off).as_f64().unwrap() < 2.0, "{}", it.page.eval(off));
}

/// A roller much longer than thick leaves the view from its end little room, and the last number of
/// an axis stands at the edge of its chart.
fn words_of_the_drawings_are_inside(it: &mut Explored) {
    let before = it.state()["values"]["roller.length_m"].as_f64().unwrap() * 1e3;
    it.type_in("roller.length_m", "300");
    let outside = "[...document.querySelectorAll('#drawing text, .chart:not([hidden]) text')].filter((t) => { \
                   const d = t.closest('svg').getBoundingClientRect(); \
                   const r = t.getBoundingClientRect(); return r.left < d.left || r.right > d.right; \
                   }).map((t) => t.textContent)";
    assert_eq!(it.page.eval(outside), json!([]));
    it.type_in("roller.length_m", &before.to_string());
}

/// Resident memory of a process (MB), and the processor time that it has used (ticks).
fn usage(pid: u32) -> (f64, u64) {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    let kb: f64 = line.trim().trim_end_matches(" kB").parse().unwrap();
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap().split_whitespace().collect();
    (kb / 1024.0, fields[11].parse::<u64>().unwrap() + fields[12].parse::<u64>().unwrap())
}

#[test]
fn two_hundred_moves_end_in_the_last_state_and_leave_nothing_behind() {
    let Some(mut it) = Explored::new() else { return };
    let pid = it.explorer.child.id();
    let mut medians = Vec::new();
    let (before, _) = usage(pid);
    // A flush block and a longer one.
    for length in ["3", "6"] {
        it.type_in("block.length_m", length);
        it.page.eval("performance.clearMeasures()");
        it.page
            .eval("document.querySelector('input[type=range][data-key=\"load.force_n\"]').focus()");
        for i in 0..100 {
            it.page.press(if i % 20 < 12 { "ArrowRight" } else { "ArrowLeft" });
            std::thread::sleep(Duration::from_millis(15));
        }
        it.rest();
        let moves = it.page.eval("performance.getEntriesByName('move').map(m => m.duration)");
        let mut moves: Vec<f64> = serde_json::from_value(moves).unwrap();
        moves.sort_by(f64::total_cmp);
        medians.push(moves[moves.len() / 2]);
        it.same_as_solve("after a hundred moves");
    }
    // How quick they are is no matter of a test, which shares its machine with others
    // (docs/performance.md).
    eprintln!("from a move to the screen: {medians:?} ms in the median, flush and longer");
    let (after, ticks) = usage(pid);
    assert!(after < before + 50.0, "{before} MB before, {after} MB after");
    std::thread::sleep(Duration::from_secs(1));
    let busy = usage(pid).1 - ticks;
    assert!(busy <= 5, "{busy} ticks of the processor while nothing is asked for");
}

#[test]
fn it_is_readable_at_two_widths_in_two_schemes_and_tells_when_it_has_ended() {
    let Some(mut it) = Explored::new() else { return };
    let pictures = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for (width, height) in [(1280, 900), (390, 844)] {
        it.page.resize(width, height);
        for scheme in ["light", "dark"] {
            it.page.scheme(scheme);
            it.page.wait("document.documentElement.scrollWidth <= innerWidth");
            let within = "[...document.querySelectorAll('.card, .tile, .field:not([hidden]), .top > *')].every(\
                          (e) => e.getBoundingClientRect().right <= innerWidth + 0.5)";
            it.page.wait(within);
            let ink = it.page.text("getComputedStyle(document.body).color");
            assert_eq!(ink == "rgb(22, 25, 29)", scheme == "light", "{ink}");
            let name = format!("explore-{width}-{scheme}.png");
            assert_eq!(it.page.picture(&pictures.join(name)), (width, height));
        }
    }
    every_chart_is_drawn_in_the_end_and_on_paper(&mut it);
    words_of_the_drawings_are_inside(&mut it);
    // Where the system sets the colours, the chosen form still differs.
    let forced = json!({ "features": [{ "name": "forced-colors", "value": "active" }] });
    it.page.call("Emulation.setEmulatedMedia", forced);
    let differ = "new Set([...document.querySelectorAll('#form span')].map((s) => getComputedStyle(s).backgroundColor)).size";
    assert_eq!(it.page.eval(differ), json!(2));
    // A screenshot of the page does not tell the secret word.
    assert!(!it.page.text("document.documentElement.innerText").contains(&it.explorer.token));
    // Every field and chart has a name for those who do not see it.
    let unnamed = "[...document.querySelectorAll('input, select, svg[role=img]')].filter((e) => !e.closest('[hidden]') && \
                   !(e.labels && e.labels.length) && !e.getAttribute('aria-label')).map((e) => e.outerHTML.slice(0, 120))";
    assert_eq!(it.page.eval(unnamed), json!([]));
    it.explorer.child.kill().unwrap();
    it.explorer.ended();
    it.page.wait("!document.getElementById('gone').hidden");
}
