//! Curves as inline SVG.

use std::fmt::Write;

/// Size of a plot, and where its axes are.
const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 260.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;

/// Curves that fall over decades, and points beside them.
#[derive(Clone)]
pub(super) struct Plot<'a> {
    /// What the horizontal axis is.
    pub across: &'a str,
    /// What the vertical axis is, a fraction.
    pub up: &'a str,
    pub curves: Vec<Vec<(f64, f64)>>,
    /// Points of another quantity, a fraction too.
    pub marks: Vec<(f64, f64)>,
    /// What that is.
    pub name: &'a str,
}

impl Plot<'_> {
    /// The plot as an `svg` element; empty if there is nothing to draw.
    pub fn svg(&self) -> String {
        let curves: Vec<Vec<(f64, f64)>> = self.curves.iter().map(|curve| drawn(curve)).collect();
        let marks = drawn(&self.marks);
        let all = || curves.iter().flatten().chain(&marks);
        let least = all().map(|p| p.1).fold(f64::INFINITY, f64::min);
        let end = all().map(|p| p.0).fold(0.0, f64::max);
        if curves.iter().all(Vec::is_empty) || end <= 0.0 {
            return String::new();
        }
        let decades = (-least.max(1e-12).log10()).ceil().clamp(1.0, 12.0);
        let scale = Scale { end, decades };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{} over {}\">\n",
            self.up, self.across
        );
        self.axes(&mut svg, &scale);
        for curve in &curves {
            let line = scale.line(curve);
            let _ = writeln!(svg, "<polyline class=\"curve\" points=\"{line}\"/>");
        }
        self.mark(&mut svg, &scale, &marks);
        svg + "</svg>\n"
    }

    /// The other quantity's points, joined, the last with its name.
    fn mark(&self, svg: &mut String, scale: &Scale, marks: &[(f64, f64)]) {
        let Some(&(x, y)) = marks.last() else { return };
        if marks.len() > 1 {
            let line = scale.line(marks);
            let _ = writeln!(svg, "<polyline class=\"marks\" points=\"{line}\"/>");
        }
        for (x, y) in marks {
            let _ = writeln!(
                svg,
                "<circle class=\"mark\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"3.5\"/>",
                scale.x(*x),
                scale.y(*y)
            );
        }
        let _ = writeln!(
            svg,
            "<text class=\"mark\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{} {:.2} %</text>",
            scale.x(x) - 7.0,
            scale.y(y) + 14.0,
            self.name,
            100.0 * y
        );
    }

    fn axes(&self, svg: &mut String, scale: &Scale) {
        let (bottom, right) = (HEIGHT - BOTTOM, WIDTH - RIGHT);
        for decade in 0..=scale.decades as i32 {
            let y = scale.y(10f64.powi(-decade));
            let _ = writeln!(
                svg,
                "<line class=\"grid\" x1=\"{LEFT}\" y1=\"{y:.1}\" x2=\"{right}\" y2=\"{y:.1}\"/>\
                 <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                LEFT - 6.0,
                y + 4.0,
                percent(decade)
            );
        }
        let step = round_step(scale.end);
        let ticks = (scale.end / step + 1e-9) as usize;
        for tick in 0..=ticks {
            let value = tick as f64 * step;
            let x = scale.x(value);
            let text = (value * 1e6).round() / 1e6;
            let _ = writeln!(
                svg,
                "<line class=\"grid\" x1=\"{x:.1}\" y1=\"{TOP}\" x2=\"{x:.1}\" y2=\"{bottom}\"/>\
                 <text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{text}</text>",
                bottom + 16.0
            );
        }
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\
             <text transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            (LEFT + right) / 2.0,
            HEIGHT - 8.0,
            self.across,
            (TOP + bottom) / 2.0,
            self.up
        );
    }
}

/// What a logarithmic scale can show.
fn drawn(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    points.iter().filter(|(_, y)| *y > 0.0).copied().collect()
}

/// From values to places.
struct Scale {
    end: f64,
    decades: f64,
}

impl Scale {
    fn line(&self, points: &[(f64, f64)]) -> String {
        let place = |(x, y): &(f64, f64)| format!("{:.1},{:.1}", self.x(*x), self.y(*y));
        points.iter().map(place).collect::<Vec<_>>().join(" ")
    }

    fn x(&self, value: f64) -> f64 {
        LEFT + (WIDTH - LEFT - RIGHT) * value / self.end
    }

    fn y(&self, value: f64) -> f64 {
        let down = (-value.log10() / self.decades).clamp(0.0, 1.0);
        TOP + (HEIGHT - TOP - BOTTOM) * down
    }
}

/// 100 %, 10 %, 1 % …
fn percent(decade: i32) -> String {
    match decade {
        0 => "100 %".into(),
        1 => "10 %".into(),
        2 => "1 %".into(),
        n => format!("{:.*} %", n as usize - 2, 10f64.powi(2 - n)),
    }
}

/// A step of 1, 2 or 5 that a length holds at most six times.
fn round_step(length: f64) -> f64 {
    let power = 10f64.powf((length / 6.0).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    let fits = steps.into_iter().find(|step| length / step <= 6.0);
    fits.unwrap_or(length)
}
