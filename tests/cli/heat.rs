//! `radiosity form-factors --temperatures`.

use super::matrices::{OPPOSITE, cube, form_factors};
use super::{folder, names, text};
use std::fs;

#[test]
fn heat_flows_from_the_hot_to_the_cold() {
    let folder = folder();
    let output = folder.path().join("F.csv");
    let temperatures = folder.path().join("T.csv");
    let table = "label,temperature_K,emissivity\nback,500,1\nfront,300,1\nfloor,300,1\ntop,300,1\nleft,300,1\nright,300,1\n";
    fs::write(&temperatures, table).expect("can be written");
    let more = [
        "--temperatures",
        text(&temperatures),
        "--enforce",
        "closure",
    ];
    let run = form_factors(&cube(&folder), &output, &more);
    run.assert_success();
    assert!(run.out.contains("enforced"), "{}", run.out);
    let solved = fs::read_to_string(folder.path().join("F.radiosity.csv")).expect("was written");
    let net: Vec<f64> = solved
        .lines()
        .skip(1)
        .map(|line| {
            line.rsplit(',')
                .next()
                .and_then(|n| n.parse().ok())
                .expect("a number")
        })
        .collect();
    // Black faces: σ (500⁴ - 300⁴) leaves the hot one, and arrives at the others in proportion to F.
    let hot = 5.670374419e-8 * (500f64.powi(4) - 300f64.powi(4));
    assert!((net[0] / hot - 1.0).abs() < 1e-9, "{net:?} {hot}");
    assert!(
        (net[1] + OPPOSITE * hot).abs() < 1e-3 * hot && net.iter().sum::<f64>().abs() < 1e-9 * hot
    );
}

#[test]
fn temperatures_that_do_not_fit_the_rows_are_refused_and_leave_nothing() {
    let folder = folder();
    let (cube, output) = (cube(&folder), folder.path().join("F.csv"));
    let temperatures = folder.path().join("T.csv");
    for (zones, expected) in [
        ("back,500\nroof,300\n", ["T.csv:3", "`roof`"]),
        ("back,500\n", ["T.csv", "no temperature of `front`"]),
        ("back,-5\n", ["T.csv:2", "-5"]),
        ("back,warm\n", ["T.csv:2", "`warm`"]),
        ("back,500\nback,300\n", ["T.csv:3", "`back` again"]),
    ] {
        let table = format!("label,temperature_K\n{zones}");
        fs::write(&temperatures, table).expect("can be written");
        form_factors(&cube, &output, &["--temperatures", text(&temperatures)])
            .assert_refused(3, &expected);
        assert_eq!(names(folder.path()), ["T.csv", "cube.obj"]);
    }
}

/// The run with this text as its table of temperatures.
fn with_table(table: &str) -> super::Run {
    let folder = folder();
    let temperatures = folder.path().join("T.csv");
    fs::write(&temperatures, table).expect("can be written");
    let output = folder.path().join("F.csv");
    form_factors(
        &cube(&folder),
        &output,
        &["--temperatures", text(&temperatures)],
    )
}

#[test]
fn a_table_without_the_columns_is_told_which_they_are() {
    with_table("label,temperature\nback,500\n")
        .assert_refused(3, &["T.csv:1", "`label,temperature`", "`temperature_K`"]);
    with_table("label;temperature_K\nback;500\n").assert_refused(
        3,
        &["T.csv:1", "`label;temperature_K`", "`label`", "commas"],
    );
    with_table("label,temperature_K\nback\n").assert_refused(3, &["T.csv:2", "1 columns"]);
}

#[test]
fn light_and_heat_are_not_solved_at_once() {
    let folder = folder();
    let output = folder.path().join("F.csv");
    let both = ["--solve", "--temperatures", "T.csv"];
    let run = form_factors(&cube(&folder), &output, &both);
    run.assert_refused(2, &["--solve", "--temperatures"]);
}

#[test]
fn a_column_that_is_not_read_is_named() {
    let run = with_table(
        "label,temperature_K,emisivity\nback,5,1\nfront,3,1\nfloor,3,1\ntop,3,1\nleft,3,1\nright,3,1\n",
    );
    run.assert_success();
    let warned = run.err.contains("`emisivity`") && run.err.contains("temperature_K, emissivity");
    assert!(warned, "{}", run.err);
}
