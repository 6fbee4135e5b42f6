//! Values of quantities that come without a field: from the command line, or from a file.

use std::path::{Path, PathBuf};

use super::points;
use crate::cli::{CliError, Exit};
use crate::scene::Scene;
use crate::study::GivenValue;

/// Most bytes a file of values may have.
const MOST_BYTES: u64 = 1 << 20;

/// Where values come from.
#[derive(Debug, Clone, clap::Args)]
pub struct ValueOptions {
    /// Hold a value of quantity NAME from elsewhere against its interval; may be repeated
    #[arg(long, value_name = "NAME=X")]
    pub value: Vec<GivenValue>,
    /// Hold the values in FILE against their intervals: a TOML or JSON table of names and numbers, or CSV with the columns
    /// name,value or x,y,quantity,value for values at points
    #[arg(long, value_name = "FILE")]
    pub values: Option<PathBuf>,
}

impl ValueOptions {
    /// All of them, those of the file first; `scene` is asked for values at points that only the file has.
    ///
    /// # Errors
    /// The file is refused.
    pub fn all(&self, scene: &mut Scene) -> Result<Vec<GivenValue>, CliError> {
        let mut all = match &self.values {
            Some(file) => read(file, scene)?,
            None => Vec::new(),
        };
        for value in &self.value {
            if self.value.iter().filter(|other| other.name == value.name).count() > 1 {
                let message = format!("--value gives {} twice", value.name);
                return Err(CliError::stopped(Exit::BadInput, message, "give one value for a quantity"));
            }
            all.push(value.clone());
        }
        Ok(all)
    }
}

/// Reads a table of numbers.
fn read(path: &Path, scene: &mut Scene) -> Result<Vec<GivenValue>, CliError> {
    let refused = |what: String, remedy: &str| {
        CliError::stopped(Exit::BadInput, format!("{}: {what}", path.display()), remedy.to_string())
    };
    let shape =
        "write a table of names and numbers, in TOML (tip = 0.8014), JSON ({\"tip\": 0.8014}) or CSV (name,value)";
    let size = std::fs::metadata(path).map_err(|e| refused(e.to_string(), "give the path of a file of values"))?;
    if !size.is_file() || size.len() > MOST_BYTES {
        return Err(refused("it is no regular file of less than a megabyte".to_string(), shape));
    }
    let text = std::fs::read_to_string(path).map_err(|e| refused(e.to_string(), shape))?;
    if points::is_table(&text) {
        let rows = points::read(&text).map_err(|what| refused(what, points::SHAPE))?;
        let (changed, values) = points::asked(scene, &rows).map_err(|what| refused(what, points::SHAPE))?;
        if let Some(changed) = changed {
            *scene = changed;
        }
        if values.is_empty() {
            return Err(refused("it holds no value".to_string(), points::SHAPE));
        }
        return Ok(values);
    }
    let table: toml::Table = if text.trim_start().starts_with('{') {
        serde_json::from_str(&text).map_err(|e| refused(e.to_string(), shape))?
    } else {
        toml::from_str(&text).map_err(|e| refused(e.message().to_string(), shape))?
    };
    if table.is_empty() {
        return Err(refused("it holds no value".to_string(), shape));
    }
    table
        .into_iter()
        .map(|(name, value)| {
            let number = value.as_float().or_else(|| value.as_integer().map(|i| i as f64));
            match number.filter(|number| number.is_finite()) {
                Some(value) => Ok(GivenValue::new(name, value)),
                None => Err(refused(format!("the value of '{name}' is {value}, no finite number"), shape)),
            }
        })
        .collect()
}
