//! The keys of a `scene.toml`, with the lines where they stand.

use super::geometry::Reading;
use super::text::{TextFile, quote};
use super::{SceneError, limits};
use glam::DVec3;
use serde::Deserialize;
use serde::de::{self, Deserializer, SeqAccess, Visitor};
use std::collections::BTreeMap;
use std::fmt;
use toml::Spanned;

/// A `scene.toml` as it is written.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settings {
    pub name: Option<String>,
    pub geometry: Option<Spanned<String>>,
    pub unit: Option<Spanned<String>>,
    pub metres_per_unit: Option<Spanned<f64>>,
    pub up: Option<UpAxis>,
    pub point_light_radius: Option<Spanned<f64>>,
    pub sides: Option<SidesRule>,
    #[serde(default)]
    pub material: BTreeMap<String, Spanned<MaterialSettings>>,
    #[serde(default)]
    pub camera: Vec<Spanned<CameraSettings>>,
}

/// The axis that points up in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum UpAxis {
    #[default]
    Y,
    Z,
}

impl UpAxis {
    /// A point of a file with z up in a scene with y up: a quarter turn about the x axis.
    pub fn turned(point: DVec3) -> DVec3 {
        DVec3::new(point.x, point.z, -point.y)
    }
}

/// How the sides of surfaces are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum SidesRule {
    Front,
    Both,
    Auto,
}

/// `[material.NAME]`: what it says here holds against the MTL file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialSettings {
    pub reflectance: Option<Spanned<Channels>>,
    pub emitted_radiance: Option<Spanned<Channels>>,
    pub sides: Option<SidesRule>,
}

/// `[[camera]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraSettings {
    pub name: String,
    pub eye: [f64; 3],
    pub look_at: [f64; 3],
    pub up: Option<[f64; 3]>,
    pub horizontal_fov: Option<f64>,
    pub width: Option<i64>,
    pub height: Option<i64>,
    pub exposure: Option<f64>,
}

/// Three channels, written as `[r, g, b]` or as one number for all three.
#[derive(Debug, Clone, Copy)]
pub(super) struct Channels(pub [f64; 3]);

impl<'de> Deserialize<'de> for Channels {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ChannelsVisitor)
    }
}

struct ChannelsVisitor;

impl<'de> Visitor<'de> for ChannelsVisitor {
    type Value = Channels;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a number or [r, g, b]")
    }

    fn visit_f64<E: de::Error>(self, grey: f64) -> Result<Channels, E> {
        Ok(Channels([grey; 3]))
    }

    fn visit_i64<E: de::Error>(self, grey: i64) -> Result<Channels, E> {
        Ok(Channels([grey as f64; 3]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Channels, A::Error> {
        let mut channels = [0.0; 3];
        for (index, channel) in channels.iter_mut().enumerate() {
            *channel = sequence
                .next_element()?
                .ok_or_else(|| de::Error::invalid_length(index, &self))?;
        }
        match sequence.next_element::<f64>()? {
            Some(_) => Err(de::Error::invalid_length(4, &self)),
            None => Ok(Channels(channels)),
        }
    }
}

/// Reads the keys of a `scene.toml`.
pub(super) fn read(file: &TextFile) -> Result<Settings, SceneError> {
    toml::from_str(&file.text).map_err(|error| {
        let line = error.span().map(|span| file.line_at(span.start));
        let message = error.message().trim().replace('\n', ", ");
        // The parser says both halves of the sentence, where it knows what it expected.
        match message.split_once(", expected ") {
            Some((found, expected)) => file.error(line, found, expected),
            None => file.error(line, message, "TOML with the keys of a scene"),
        }
    })
}

impl Settings {
    /// How the geometry file is to be read.
    pub fn reading(&self, file: &TextFile) -> Result<Reading, SceneError> {
        let radius = self.point_light_radius.as_ref();
        if let Some(wrong) =
            radius.filter(|radius| !(0.0..=limits::COORDINATE).contains(radius.get_ref()))
        {
            let found = format!("point_light_radius = {}", wrong.get_ref());
            let line = file.line_at(wrong.span().start);
            let expected = "a radius up to 1e18, or 0 to leave such lights out";
            return Err(file.error(line, found, expected));
        }
        Ok(Reading {
            point_light_radius: radius.map(|radius| *radius.get_ref()),
            metres_per_unit: self.metres_per_unit(file)?,
            ..Reading::default()
        })
    }

    /// The length of the scene's unit in metres; 1 where the file says nothing.
    pub fn metres_per_unit(&self, file: &TextFile) -> Result<f64, SceneError> {
        match (&self.unit, &self.metres_per_unit) {
            (None, None) => Ok(1.0),
            (Some(unit), Some(_)) => {
                let line = file.line_at(unit.span().start);
                Err(file.error(line, "both `unit` and `metres_per_unit`", "one of them"))
            }
            (Some(unit), None) => metres(unit.get_ref()).ok_or_else(|| {
                let found = format!("the unit {}", quote(unit.get_ref()));
                let expected =
                    "\"m\", \"cm\", \"mm\", \"in\" or \"ft\"; or `metres_per_unit` instead";
                file.error(file.line_at(unit.span().start), found, expected)
            }),
            (None, Some(length)) => match *length.get_ref() {
                metres if limits::UNIT.contains(&metres) => Ok(metres),
                other => {
                    let line = file.line_at(length.span().start);
                    let (least, most) = (limits::UNIT.start(), limits::UNIT.end());
                    let expected = format!("{least:e} to {most:e} metres");
                    let found = format!("metres_per_unit = {other:?}");
                    Err(file.error(line, found, expected))
                }
            },
        }
    }
}

fn metres(unit: &str) -> Option<f64> {
    match unit {
        "m" => Some(1.0),
        "cm" => Some(0.01),
        "mm" => Some(0.001),
        "in" => Some(0.0254),
        "ft" => Some(0.3048),
        _ => None,
    }
}
