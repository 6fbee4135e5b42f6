//! The XML of a VTK file under construction, with its arrays compressed.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

use crate::report::deflate::deflated;

/// Bytes that are compressed together.
const BLOCK: usize = 1 << 20;
/// How hard to compress, from 0 to 9.
const LEVEL: u32 = 6;
/// Bits of the mantissa that are kept where numbers are for looking at: they then have four digits.
const KEPT_BITS: u32 = 13;

/// How the numbers of fields are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Precision {
    /// As they are, in double precision.
    Whole,
    /// In single precision with four digits, stresses to a part of the largest in their triangle.
    ForLooking,
}

/// The file under construction.
pub(super) struct Sheet {
    xml: Writer<Vec<u8>>,
    precision: Precision,
}

impl Sheet {
    /// The beginning of a file; `remark` stands in front as a comment.
    pub fn new(remark: &str, precision: Precision) -> std::io::Result<Self> {
        let mut sheet = Sheet { xml: Writer::new_with_indent(Vec::new(), b' ', 1), precision };
        sheet.xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        sheet.xml.write_event(Event::Comment(BytesText::new(remark)))?;
        let attributes = [
            ("type", "UnstructuredGrid"),
            ("version", "1.0"),
            ("byte_order", "LittleEndian"),
            ("header_type", "UInt64"),
            ("compressor", "vtkZLibDataCompressor"),
        ];
        sheet.open("VTKFile", &attributes)?;
        Ok(sheet)
    }

    pub fn open(&mut self, name: &str, attributes: &[(&str, &str)]) -> std::io::Result<()> {
        let start = BytesStart::new(name).with_attributes(attributes.iter().copied());
        self.xml.write_event(Event::Start(start))
    }

    pub fn close(&mut self, name: &str) -> std::io::Result<()> {
        self.xml.write_event(Event::End(BytesEnd::new(name)))
    }

    /// The whole file.
    pub fn finish(mut self) -> std::io::Result<Vec<u8>> {
        self.close("VTKFile")?;
        let mut bytes = self.xml.into_inner();
        bytes.push(b'\n');
        Ok(bytes)
    }

    /// A field of floating-point numbers in the precision of this file; its components have these names, and one of a single
    /// component has none.
    pub fn field(&mut self, name: &str, components: &[&str], values: &[f64]) -> std::io::Result<()> {
        match self.precision {
            Precision::Whole => {
                self.array(name, "Float64", components, values.iter().flat_map(|x| x.to_le_bytes()).collect())
            }
            Precision::ForLooking => {
                let bytes = values.iter().flat_map(|&x| shortened(x as f32).to_le_bytes()).collect();
                self.array(name, "Float32", components, bytes)
            }
        }
    }

    /// A field of stresses, one tensor or scalar at every node; for looking at they are rounded to the steps of the nodes.
    pub fn stresses(&mut self, name: &str, components: &[&str], values: &[f64], steps: &[f64]) -> std::io::Result<()> {
        if self.precision == Precision::Whole {
            return self.field(name, components, values);
        }
        let round = |(values, step): (&[f64], &f64)| {
            let step = *step;
            values.iter().map(move |x| if step > 0.0 { (x / step).round() * step } else { *x }).collect::<Vec<f64>>()
        };
        let rounded = values.chunks(components.len().max(1)).zip(steps).flat_map(round);
        self.array(name, "Float32", components, rounded.flat_map(|x| (x as f32).to_le_bytes()).collect())
    }

    /// Text as an array of its bytes in UTF-8, which every reader takes.
    pub fn text(&mut self, name: &str, text: &str) -> std::io::Result<()> {
        let tuples = text.len().to_string();
        self.element(name, "UInt8", &[("NumberOfTuples", tuples.as_str())], text.as_bytes())
    }

    /// Rows of so many numbers, as field data.
    pub fn table(&mut self, name: &str, kind: &str, columns: usize, rows: usize, data: &[u8]) -> std::io::Result<()> {
        let (columns, rows) = (columns.to_string(), rows.to_string());
        let shape = [("NumberOfComponents", columns.as_str()), ("NumberOfTuples", rows.as_str())];
        self.element(name, kind, &shape, data)
    }

    /// An array whose components have these names; one of a single component has none.
    pub fn array(&mut self, name: &str, kind: &str, components: &[&str], data: Vec<u8>) -> std::io::Result<()> {
        let count = components.len().to_string();
        let keys: Vec<String> = (0..components.len()).map(|k| format!("ComponentName{k}")).collect();
        let mut attributes: Vec<(&str, &str)> =
            keys.iter().map(String::as_str).zip(components.iter().copied()).collect();
        // Scalars go without the count, as VTK itself writes them: some readers make a column of one otherwise.
        if !components.is_empty() {
            attributes.push(("NumberOfComponents", &count));
        }
        self.element(name, kind, &attributes, &data)
    }

    /// Inline binary, compressed in blocks: numbers of blocks and bytes in base64, and the blocks in base64.
    fn element(&mut self, name: &str, kind: &str, more: &[(&str, &str)], data: &[u8]) -> std::io::Result<()> {
        let blocks: Vec<Vec<u8>> = data.chunks(BLOCK).map(|block| deflated(block, LEVEL)).collect();
        let counts = [blocks.len(), BLOCK, data.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len));
        let head: Vec<u8> = counts.flat_map(|n| (n as u64).to_le_bytes()).collect();
        let attributes = [("type", kind), ("Name", name), ("format", "binary")];
        let element = self.xml.create_element("DataArray").with_attributes(attributes);
        let text = STANDARD.encode(head) + &STANDARD.encode(blocks.concat());
        element.with_attributes(more.iter().copied()).write_text_content(BytesText::from_escaped(text))?;
        Ok(())
    }
}

/// The nearest number with `KEPT_BITS` bits behind the leading one.
pub(in crate::report) fn shortened(x: f32) -> f32 {
    let dropped = f32::MANTISSA_DIGITS - 1 - KEPT_BITS;
    if !x.is_finite() {
        return x;
    }
    let rounded = f32::from_bits((x.to_bits() + (1 << (dropped - 1))) & !((1 << dropped) - 1));
    if rounded.is_finite() { rounded } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_are_kept() {
        for x in [1.0_f32, -0.3333333, 1.2345678e-20, 9.999999e20, 0.0, f32::MAX] {
            assert!((shortened(x) - x).abs() <= 6.2e-5 * x.abs(), "{x}");
        }
        assert!(shortened(f32::NAN).is_nan() && shortened(f32::INFINITY).is_infinite());
    }
}
