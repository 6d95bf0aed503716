//! The report page in a real browser.

use crate::chromium::{Page, browser};
use crate::support::{edgeline, number, rows, succeeded};
use serde_json::json;
use std::path::{Path, PathBuf};

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
    let Some(program) = browser() else { return };
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
    assert_eq!(page.complaints("file:"), Vec::<String>::new());
}

/// On a narrow screen the page of a solution is no wider than that, and its pictures scroll: drawn
/// as wide as the screen, what is written in them could not be read.
#[test]
fn the_page_of_a_solution_fits_a_narrow_screen() {
    let Some(program) = browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    let solve = ["solve", "flush-short", "--tolerance", "1e-2", "--plots", "--out", "run"];
    succeeded(&mut edgeline(folder.path(), &solve));
    let mut page = Page::open(&program, &folder.path().join("run/summary.html"));
    page.resize(390, 844);
    page.wait("innerWidth === 390");
    assert_eq!(page.eval("document.documentElement.scrollWidth <= innerWidth"), json!(true));
    let widths = page.text(
        "[...document.querySelectorAll('figure svg')].map((e) => e.clientWidth >= 700).join()",
    );
    assert!(widths.starts_with("true") && !widths.contains("false"), "{widths}");
    assert_eq!(page.complaints("file:"), Vec::<String>::new());
}
