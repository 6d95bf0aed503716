use super::super::*;
use crate::base::Result;
use proptest::prelude::*;
use std::path::Path;

const GRID: &str = "[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = [0.3, 0.25]\n\
    [block]\nyoung_pa = 210e9\npoisson = 0.3\n\
    [dimensionless]\nW = { from = 1e-4, to = 1e-2, count = 3, spacing = \"log\" }\n\
    S_l = 5\nL_r = [0.5, 1.0]\n";

fn parse(text: &str) -> Result<Sweep> {
    Sweep::parse(text, Path::new("s.toml"))
}

/// The texts of all rows.
fn cells(sweep: &Sweep) -> Vec<Vec<String>> {
    sweep.rows().unwrap().map(|row| row.unwrap()).collect()
}

/// The case of row `i`.
fn case(sweep: &Sweep, i: usize) -> Result<Case> {
    sweep.case(i, &cells(sweep)[i])
}

fn table(text: &str, base: Option<&str>) -> Result<Sweep> {
    let base = base.map(|name| Draft::find(Path::new(name)).unwrap());
    Sweep::parse_csv(text, Path::new("s.csv"), base.as_ref())
}

#[test]
fn a_grid_is_every_combination_and_the_last_varies_fastest() {
    let sweep = parse(GRID).unwrap();
    assert_eq!(sweep.columns(), ["roller.poisson", "dimensionless.W", "dimensionless.L_r"]);
    assert_eq!(sweep.len(), 12);
    let cells: Vec<String> = cells(&sweep).iter().map(|row| row.join(" ")).collect();
    assert_eq!(cells[..3], ["3e-1 1e-4 5e-1", "3e-1 1e-4 1e0", "3e-1 1e-3 5e-1"]);
    assert_eq!(cells[11], "2.5e-1 1e-2 1e0");
    let case = case(&sweep, 9).unwrap();
    assert_eq!((case.name.as_str(), case.roller.material.poisson), ("row-10", 0.25));
    let factors = case.factors();
    assert!((factors.load - 1e-3).abs() < 1e-15 && (factors.slenderness - 5.0).abs() < 1e-12);
    assert_eq!(case.accuracy, Accuracy::default());
}

#[test]
fn lists_side_by_side_are_rows() {
    let text = GRID.replace("{ from = 1e-4, to = 1e-2, count = 3, spacing = \"log\" }", "1e-3")
        + "[sweep]\ncombine = \"list\"\n[accuracy]\ntolerance = 1e-2\n";
    let sweep = parse(&text).unwrap();
    assert_eq!(cells(&sweep), [["3e-1", "5e-1"], ["2.5e-1", "1e0"]]);
    assert_eq!(case(&sweep, 1).unwrap().accuracy.tolerance, 1e-2);
    let uneven = text.replace("[0.5, 1.0]", "[0.5, 0.7, 1.0]");
    let said = parse(&uneven).unwrap_err().to_string();
    assert!(said.contains("s.toml:11: dimensionless.L_r") && said.contains("side by side"));
}

#[test]
fn the_example_is_what_it_promises() {
    let sweep = parse(include_str!("../../../examples/sweep.toml")).unwrap();
    assert_eq!(sweep.len(), 1050);
    assert_eq!(sweep.columns(), ["dimensionless.W", "dimensionless.S_l", "dimensionless.L_r"]);
    assert!(cells(&sweep).iter().enumerate().all(|(i, row)| sweep.case(i, row).is_ok()));
}

#[test]
fn one_case_is_a_sweep_of_one_row() {
    let sweep = parse(include_str!("../../../cases/flush-short.toml")).unwrap();
    assert_eq!((sweep.len(), sweep.columns().len()), (1, 0));
    assert!((case(&sweep, 0).unwrap().factors().load - 5e-4).abs() < 1e-15);
}

#[test]
fn what_is_wrong_with_the_file_is_an_error() {
    for (from, to, wanted) in [
        ("poisson = 0.3", "poison = 0.3", "s.toml:7: unknown key block.poison; did you mean"),
        ("S_l = 5", "S_l = \"5\"", "dimensionless.S_l = \"5\" is not valid: a number"),
        ("S_l = 5", "S_l = []", "dimensionless.S_l = []"),
        ("S_l = 5\n", "", "dimensionless.S_l is missing"),
        ("L_r = [0.5, 1.0]", "L_r = [0.5, true]", "a finite number belongs here"),
        ("count = 3", "count = 2.5", "a whole number between 2"),
        ("count = 3", "counts = 3", "did you mean count"),
        ("from = 1e-4", "from = 0", "equal ratios"),
        ("count = 3", "count = 10000000", "more than 10000000 rows"),
        ("[dimensionless]", "[load]\nforce_n = 1\n[dimensionless]", "the load is given twice"),
        ("[block]", "[sweep]\ncombine = \"zip\"\n[block]", "lists are combined in one of two"),
        ("[block]", "[blok]", "unknown key blok; did you mean block"),
        (
            "[block]",
            "[cells]\nhalf_width_m = [1e-3, 2e-3]\n[block]",
            "cells.half_width_m = [1e-3, 2e-3] is not valid: a sweep solves contacts along a line",
        ),
        (
            "radius_m = 10e-3",
            "radius_m = 10e-3\nlength_m = 1",
            "s.toml:3: roller.length_m = 1 is not valid: the lengths follow",
        ),
    ] {
        assert!(GRID.contains(from), "{from}");
        let said = parse(&GRID.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(said.contains(wanted), "{to}: {said}");
    }
}

#[test]
fn what_is_wrong_with_a_row_belongs_to_the_row() {
    let sweep = parse(&GRID.replace("[0.5, 1.0]", "[0.5, 1500]")).unwrap();
    assert!(case(&sweep, 0).is_ok());
    let said = case(&sweep, 1).unwrap_err().to_string();
    assert!(said.starts_with("dimensionless.L_r = 1500 is not valid: L_r"), "{said}");
}

#[test]
fn a_table_takes_short_names_and_a_base() {
    let text = "name,W,S_l,L_r,poisson\na,1e-4,5,1,0.3\nb, 2e-4 ,6,0.5,0.25\nc,x,6,0.5,0.25\n";
    let sweep = table(text, Some("half-short")).unwrap();
    assert_eq!((sweep.len(), sweep.columns().len()), (3, 5));
    let b = case(&sweep, 1).unwrap();
    assert_eq!((b.name.as_str(), b.roller.radius_m), ("b", 10e-3));
    assert_eq!((b.block.material.poisson, b.roller.material.poisson), (0.25, 0.25));
    assert!(case(&sweep, 2).unwrap_err().to_string().starts_with("W = x is not valid"));
    let said = table(text, None).unwrap_err().to_string();
    assert!(said.contains("s.csv:1: has no column for roller.radius_m"), "{said}");

    let loads = "force_n,roller_length_m,block.length_m\n1500,1e-3,2e-3\nnan,1e-3,2e-3\n";
    let sweep = table(loads, Some("half-short")).unwrap();
    assert_eq!(case(&sweep, 0).unwrap().load.force_n, 1500.0);
    assert!(case(&sweep, 1).unwrap_err().to_string().contains("a finite number belongs here"));
    // The loads alone take the base's lengths.
    let sweep = table("force_n\n100\n", Some("half-short")).unwrap();
    let base = crate::case::builtin_case("half-short").unwrap().unwrap();
    assert!((case(&sweep, 0).unwrap().roller.length_m / base.roller.length_m - 1.0).abs() < 1e-14);
}

#[test]
fn broken_tables_are_errors() {
    for (text, wanted) in [
        ("W,S_l,Lr\n1,2,3\n", "unknown column Lr; did you mean L_r?"),
        ("W,S_l,L_r\n1e-4,5\n", "s.csv:2: has 2 cells where the header has 3; give as many"),
        ("W,S_l\n\n1e-4,5\n\n\n1e-4\n", "s.csv:6: has 1 cell where the header has 2"),
        ("W,S_l,L_r\n", "has 0 rows"),
        ("W;S_l;L_r\n1e-4;5;1\n", "s.csv:1: has semicolons between its columns; write commas"),
        ("W,W\n1,1\n", "dimensionless.W is given by two columns"),
        ("poisson,block_poisson\n0.3,0.3\n", "block.poisson is given by two columns"),
        ("name,name\na,b\n", "two columns name"),
        ("W,force_n\n1e-4,1\n", "gives the load twice"),
        ("surface_dx_m\n1e-6\n", "s.csv:1: column surface_dx_m: a sweep solves contacts along"),
        ("cells.half_width_m\n1e-3\n", "a line, not on cells; remove the column"),
        ("yield_pa\n1e9\n", "column yield_pa: a sweep tells nothing of fatigue"),
    ] {
        let said = table(text, Some("flush-short")).unwrap_err().to_string();
        assert!(said.contains(wanted), "{text}: {said}");
    }
    // What is offered in place of an unknown column may be used.
    let said = table("Lr\n1\n", Some("flush-short")).unwrap_err().to_string();
    assert!(said.contains("friction") && !said.contains("cells_half_width_m"), "{said}");
}

/// A text with one slice replaced by another text.
fn mutilated(text: &'static str) -> impl Strategy<Value = String> {
    let with = "[\\[\\]{}=\"\n#,.0-9e+a-z-]{0,12}";
    (any::<prop::sample::Index>(), 0..20usize, with).prop_map(move |(at, length, with)| {
        let start = at.index(text.len());
        let end = (start + length).min(text.len());
        format!("{}{with}{}", &text[..start], &text[end..])
    })
}

const TABLE: &str =
    "name,W,S_l,L_r,poisson,tolerance\na,1e-4,5,1,0.3,1e-2\nb,2e-4,6,0.5,0.25,1e-3\n";

/// Every row of a sweep is a legal case or says what is wrong and what to do.
fn check_rows(sweep: &Sweep) {
    assert_eq!(sweep.rows().unwrap().count(), sweep.len());
    for (i, row) in sweep.rows().unwrap().take(50).enumerate() {
        let row = row.unwrap();
        assert_eq!(row.len(), sweep.columns().len());
        match sweep.case(i, &row) {
            Ok(case) => case.check().unwrap(),
            Err(e) => assert!(matches!(e, crate::base::Error::Value { .. }), "{e}"),
        }
    }
}

#[test]
fn a_table_is_read_again_from_its_file_and_must_not_change() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("t.csv");
    let write =
        |rows: usize| std::fs::write(&file, "force_n\n".to_string() + &"100\n".repeat(rows));
    write(3).unwrap();
    let base = Draft::find(Path::new("half-short")).unwrap();
    let sweep = Sweep::read(&file, Some(&base)).unwrap();
    assert_eq!((sweep.len(), cells(&sweep).len()), (3, 3));
    for rows in [2, 4] {
        write(rows).unwrap();
        let said = sweep.rows().unwrap().find_map(Result::err).unwrap().to_string();
        assert!(said.contains("t.csv: has changed since the sweep began; leave it"), "{said}");
    }
    std::fs::remove_file(&file).unwrap();
    assert!(sweep.rows().is_err());
}

proptest! {
    #[test]
    fn mutilated_sweeps_are_refused_or_every_row_is_a_case_or_says_why_not(
        text in mutilated(GRID),
        rows in mutilated(TABLE),
    ) {
        if let Ok(sweep) = parse(&text) {
            check_rows(&sweep);
        }
        for base in [None, Some("half-short")] {
            match table(&rows, base) {
                Ok(sweep) => check_rows(&sweep),
                Err(e) => prop_assert!(e.to_string().starts_with("s.csv"), "{e}"),
            }
        }
    }
}
