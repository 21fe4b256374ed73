//! `report.html`.

use super::{folder, names, scene, solve};
use roxmltree::{Document, ParsingOptions};
use std::fs;

/// The page of a solve with those flags, once it has proved well-formed and free of anything to fetch or run.
fn page(flags: &str) -> String {
    let folder = folder();
    solve(&scene("cornell-box"), folder.path(), flags).assert_success();
    let html = fs::read_to_string(folder.path().join("report.html")).expect("was written");
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(&html, options);
    let document = document.unwrap_or_else(|error| panic!("{error}"));
    for node in document.descendants() {
        let tag = node.tag_name().name();
        let idle = !["script", "link", "iframe", "object", "embed"].contains(&tag);
        assert!(idle, "<{tag}>");
        for attribute in node.attributes() {
            let (name, value) = (attribute.name(), attribute.value());
            let refers = ["src", "href", "data", "srcset"].contains(&name);
            assert!(!refers || value.starts_with("data:"), "{name}={value}");
            assert!(!name.starts_with("on"), "{name}");
        }
    }
    assert!(!html.contains("url(") && !html.contains("@import"));
    html
}

#[test]
fn the_report_is_one_page_with_everything_in_it() {
    let html = page("--preset draft");
    for words in [
        "<title>Cornell box: radiosity</title>",
        "converged",
        "estimated error of the irradiance",
        "absorbed by surfaces",
        "epsilon_fd",
        "solution.rad, report.json, solution.ply, solution.glb, solution.vtu",
        "front: light",
        "front: mesh",
    ] {
        assert!(html.contains(words), "`{words}` is not there");
    }
    assert_eq!(html.matches("src=\"data:image/png;base64,").count(), 2);
    let png = html
        .split("data:image/png;base64,")
        .nth(1)
        .and_then(|rest| rest.split('"').next());
    let png = png
        .and_then(radiosity::codec::from_base64)
        .expect("is base64");
    let picture = radiosity::codec::decode_png(&png).unwrap_or_else(|reason| panic!("{reason}"));
    assert_eq!((picture.width, picture.height), (768, 768));
    let curves: Vec<usize> = html
        .split("class=\"curve\" points=\"")
        .skip(1)
        .map(|rest| {
            rest.split('"')
                .next()
                .unwrap_or_default()
                .split(' ')
                .count()
        })
        .collect();
    assert_eq!(curves.len(), 2, "over shots and over seconds");
    assert!(curves.iter().all(|points| *points > 20), "{curves:?}");
    assert_eq!(estimates(&html), (2, 0));
    assert_eq!(
        html.matches("text-anchor=\"end\">estimated error ").count(),
        2
    );
}

/// Points and lines of estimates in both plots.
fn estimates(html: &str) -> (usize, usize) {
    let count = |what: &str| html.matches(what).count();
    (
        count("<circle class=\"mark\""),
        count("<polyline class=\"marks\""),
    )
}

#[test]
fn every_round_on_the_way_to_an_error_has_its_estimate_in_the_plot() {
    // The first round falls a little short of it.
    let html = page("--target-error 2% --max-elements 150 --no-pictures --formats none");
    let rounds = html.split("reached in ").nth(1);
    let rounds = rounds.and_then(|rest| rest.split(' ').next()?.parse::<usize>().ok());
    let rounds = rounds.expect("says how many solves it took");
    assert!(rounds > 1, "{rounds}");
    assert_eq!(estimates(&html), (2 * rounds, 2));
    let ends: Vec<[f64; 2]> = html
        .split("class=\"curve\" points=\"")
        .skip(1)
        .map(|curve| {
            let curve = curve.split('"').next().unwrap_or_default();
            let places = curve.split([' ', ',']).step_by(2);
            let places: Vec<f64> = places.map(|x| x.parse().unwrap_or(f64::NAN)).collect();
            assert!(places.is_sorted(), "{places:?}");
            [places[0], places[places.len() - 1]]
        })
        .collect();
    assert_eq!(
        ends.len(),
        2 * rounds,
        "a curve a round, over shots and over seconds"
    );
    for plot in ends.chunks(rounds) {
        assert!(
            plot.as_flattened().is_sorted(),
            "one after the other: {plot:?}"
        );
    }
}

#[test]
fn durations_and_counts_read_as_text() {
    let html = page("--target-error 20% --time-limit 1.5h --no-pictures --formats none");
    assert!(html.contains(">5400 s<"), "{html}");
    assert!(html.contains(", reached in 1 solve<"), "{html}");
}

#[test]
fn without_pictures_the_page_has_none() {
    let html = page("--preset draft --max-shots 2 --no-pictures --formats none");
    assert!(!html.contains("<img") && !html.contains("solution.ply"));
    assert!(html.contains("max-shots"));
}

#[test]
fn names_are_text_and_warnings_are_counted() {
    let folder = folder();
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n";
    fs::write(folder.path().join("a.obj"), obj).expect("can be written");
    let toml = "name = '<b>&\"'\ngeometry = 'a.obj'\n";
    let scene = folder.path().join("a.toml");
    fs::write(&scene, toml).expect("can be written");
    let output = folder.path().join("out");
    solve(&scene, &output, "--no-pictures").assert_success();
    let html = fs::read_to_string(output.join("report.html")).expect("was written");
    assert!(html.contains("<h1>&lt;b&gt;&amp;&quot;</h1>"), "{html}");
    assert!(html.contains("<h2>Warnings (3)</h2>"), "{html}");
    fs::remove_dir_all(&output).expect("is there");
    let without = "--no-pictures --no-html --formats none";
    solve(&scene, &output, without).assert_success();
    assert_eq!(names(&output), ["report.json", "solution.rad"]);
}
