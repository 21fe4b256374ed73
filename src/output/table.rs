//! The summary of finished runs as aligned text: the columns of the paper's Table 1.

/// One line of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct SummaryRow {
    /// Name of the scene.
    pub scene: String,
    /// Patches before any subdivision.
    pub input_patches: usize,
    /// Shots in all.
    pub shots: usize,
    /// Depth of the deepest quadtree; 0 where nothing was subdivided.
    pub quadtree_depth: u32,
    /// Shots after which elements could still be subdivided.
    pub meshing_shots: usize,
    /// Elements in the end.
    pub elements: usize,
    /// Time of the solve.
    pub seconds: f64,
}

const HEADINGS: [&str; 7] = [
    "scene",
    "input patches",
    "shots",
    "quadtree depth",
    "shots with meshing",
    "elements",
    "seconds",
];

/// The rows under their headings: names to the left, numbers to the right, a rule between, every line ended.
///
/// ```
/// use radiosity::output::{SummaryRow, summary_table};
/// let row = SummaryRow {
///     scene: "box".into(),
///     input_patches: 16,
///     shots: 120,
///     quadtree_depth: 5,
///     meshing_shots: 30,
///     elements: 12345,
///     seconds: 1.25,
/// };
/// assert_eq!(
///     summary_table(&[row]),
///     "scene  input patches  shots  quadtree depth  shots with meshing  elements  seconds\n\
///      -----  -------------  -----  --------------  ------------------  --------  -------\n\
///      box               16    120               5                  30     12345     1.25\n"
/// );
/// ```
pub fn summary_table(rows: &[SummaryRow]) -> String {
    let cells: Vec<[String; 7]> = rows.iter().map(cells).collect();
    let widths: [usize; 7] = std::array::from_fn(|column| {
        let widest = cells
            .iter()
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0);
        widest.max(HEADINGS[column].len())
    });
    let mut table = line(&HEADINGS.map(String::from), &widths);
    table += &line(&widths.map(|width| "-".repeat(width)), &widths);
    cells.iter().for_each(|row| table += &line(row, &widths));
    table
}

fn cells(row: &SummaryRow) -> [String; 7] {
    [
        row.scene.clone(),
        row.input_patches.to_string(),
        row.shots.to_string(),
        row.quadtree_depth.to_string(),
        row.meshing_shots.to_string(),
        row.elements.to_string(),
        format!("{:.2}", row.seconds),
    ]
}

fn line(cells: &[String; 7], widths: &[usize; 7]) -> String {
    let mut line = format!("{:<width$}", cells[0], width = widths[0]);
    for (cell, &width) in cells.iter().zip(widths).skip(1) {
        line += &format!("  {cell:>width$}");
    }
    line.push('\n');
    line
}
