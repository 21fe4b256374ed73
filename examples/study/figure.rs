//! Curves of error over some cost, both logarithmic, a panel a scene.

use plotters::coord::Shift;
use plotters::prelude::*;
use std::error::Error;
use std::ops::Range;

pub struct Curve {
    name: String,
    /// Cost and nRMS in percent.
    pub points: Vec<(f64, f64)>,
}

pub struct Panel {
    title: String,
    pub curves: Vec<Curve>,
}

impl Curve {
    pub fn new(name: &str) -> Self {
        Self {
            name: name.into(),
            points: Vec::new(),
        }
    }
}

impl Panel {
    pub fn new(title: &str) -> Self {
        Self {
            title: title.into(),
            curves: Vec::new(),
        }
    }

    /// What an axis must hold, with room around it.
    fn range(&self, of: fn(&(f64, f64)) -> f64) -> Range<f64> {
        let values = || self.curves.iter().flat_map(|c| &c.points).map(of);
        let (low, high) = (
            values().fold(f64::INFINITY, f64::min),
            values().fold(0.0, f64::max),
        );
        0.8 * low..1.25 * high
    }
}

/// Colours that stay apart for readers who confuse red and green (Okabe and Ito).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 0, 0),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(204, 121, 167),
];

/// Draws the panels, three beside one another; the first has the legend.
pub fn draw(path: &str, cost: &str, panels: &[Panel]) -> Result<(), Box<dyn Error>> {
    let (columns, rows) = (panels.len().min(3), panels.len().div_ceil(3));
    let (width, height) = if panels.len() == 1 {
        (700, 480)
    } else {
        (420, 360)
    };
    let size = (width * columns as u32, height * rows as u32);
    let root = SVGBackend::new(path, size).into_drawing_area();
    root.fill(&WHITE)?;
    for (number, (area, panel)) in root
        .split_evenly((rows, columns))
        .iter()
        .zip(panels)
        .enumerate()
    {
        draw_panel(area, cost, panel, number == 0)?;
    }
    root.present()?;
    Ok(())
}

fn draw_panel(
    area: &DrawingArea<SVGBackend, Shift>,
    cost: &str,
    panel: &Panel,
    legend: bool,
) -> Result<(), Box<dyn Error>> {
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, ("sans-serif", 16))
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(48)
        .build_cartesian_2d(
            panel.range(|p| p.0).log_scale(),
            panel.range(|p| p.1).log_scale(),
        )?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc(cost)
        .y_desc("nRMS %")
        .max_light_lines(1)
        .x_label_formatter(&|x| label(*x))
        .y_label_formatter(&|y| label(*y))
        .draw()?;
    for (curve, colour) in panel.curves.iter().zip(COLOURS) {
        let style = colour.stroke_width(2);
        chart
            .draw_series(LineSeries::new(curve.points.iter().copied(), style))?
            .label(&curve.name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], style));
        chart.draw_series(
            curve
                .points
                .iter()
                .map(|p| Circle::new(*p, 3, colour.filled())),
        )?;
    }
    if legend {
        chart
            .configure_series_labels()
            .background_style(WHITE.mix(0.8))
            .position(SeriesLabelPosition::UpperRight)
            .label_font(("sans-serif", 11))
            .draw()?;
    }
    Ok(())
}

/// 1, 2 and 5 of each decade have a label.
fn label(value: f64) -> String {
    let decade = 10f64.powf((value.log10() + 1e-9).floor());
    // Some scales have lines between those of whole digits.
    let is_here = |digit: &&f64| (value / decade - **digit).abs() < 1e-6;
    let digit = [1.0, 2.0, 5.0].iter().find(is_here);
    digit.map_or_else(String::new, |digit| {
        let decimals = (-decade.log10()).max(0.0) as usize;
        format!("{:.decimals$}", digit * decade)
    })
}
