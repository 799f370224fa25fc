//! WINDOW XML: its meaning, and refused files.

use std::path::Path;

use lobe_formats::{Format, FormatError, Measured, Place, window_xml};
use lobe_table::window::klems::{AngleBasis, KlemsMatrix};
use lobe_table::window::{self, Band, Block, Component, Data};
use lobe_testing::examples::{NINE, TREE, sheet};

fn read(text: &[u8]) -> Result<Measured<Data>, FormatError> {
    window_xml::read(text, Path::new("sheet.xml"))
}

fn values(text: &str) -> Vec<f32> {
    let sheet = read(text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    match sheet.data.bands[0].window.block(Block::ReflectionBack) {
        Some(Component::Klems(matrix)) => matrix.values().to_vec(),
        Some(Component::Tree(tree)) => tree.values().to_vec(),
        None => panic!("no block"),
    }
}

fn refused(text: &str, place: Place, found: &str) {
    let error = read(text.as_bytes()).expect_err("a refusal");
    assert_eq!(error.place, place, "{error}");
    assert!(error.found.contains(found), "{error}");
}

#[test]
fn columns_and_rows_are_transposed() {
    assert_eq!(values(&sheet("Columns", NINE)), [1.0, 4.0, 7.0, 2.0, 5.0, 8.0, 3.0, 6.0, 9.0]);
    assert_eq!(values(&sheet("Rows", NINE)), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
    assert_eq!(
        read(sheet("Rows", NINE).as_bytes()).map(|sheet| sheet.source),
        Ok(vec![("name".into(), "a & b".into())])
    );
}

#[test]
fn marks_and_lines_before_the_xml_are_skipped() {
    let plain = sheet("Rows", NINE);
    let wanted = read(plain.as_bytes()).expect("a sheet");
    assert_eq!(read(format!("Recover using: program -r\n{plain}").as_bytes()).as_ref(), Ok(&wanted));
    assert_eq!(read(format!("\u{feff}{plain}").as_bytes()).as_ref(), Ok(&wanted));
    for swap in [u16::to_le_bytes, u16::to_be_bytes] {
        let utf16: Vec<u8> = format!("\u{feff}{plain}").encode_utf16().flat_map(swap).collect();
        assert!(window_xml::matches(&utf16));
        assert_eq!(read(&utf16).as_ref(), Ok(&wanted));
    }
    assert!(!window_xml::matches(b"<?xml version=\"1.0\"?><scene/>"));
}

#[test]
fn the_definition_may_follow_the_data() {
    let text = sheet("Rows", NINE);
    let start = text.find("<DataDefinition>").expect("a definition");
    let (head, rest) = text.split_at(start);
    let (definition, data) = rest.split_at(rest.find("<WavelengthData>").expect("data"));
    let end = data.find("</Layer>").expect("the end of the layer");
    let turned = format!("{head}{}{definition}{}", &data[..end], &data[end..]);
    assert_eq!(values(&turned), values(&text));
}

#[test]
fn comments_and_sections_do_not_split_values() {
    let parted = "1 2 3 <!-- half --> 4 5 <![CDATA[6 7]]> 8 9";
    assert_eq!(values(&sheet("Rows", parted)), values(&sheet("Rows", NINE)));
}

#[test]
fn errors_name_the_line() {
    refused(&sheet("Rows", "1 2 3\n4 5 6\n7 8"), Place::Line(8), "8 values");
    refused(&sheet("Rows", "1 2 3\n4 nan 6\n7 8 9"), Place::Line(9), "nan");
    refused(&sheet("Rows", "1 2 3\n4 1e39 6\n7 8 9"), Place::Line(9), "1e39");
    refused(&sheet("Rows", "1 2 3\n&bomb; 9"), Place::Line(9), "&bomb;");
    refused(&sheet("Diagonal", NINE), Place::Line(4), "Diagonal");
    refused(&sheet("Rows", NINE).replace(">mine</Row", ">yours</Row"), Place::Line(7), "yours");
    refused(&sheet("Rows", NINE).replace("Reflection Back", "Sideways"), Place::Line(6), "Sideways");
    refused(&sheet("Rows", NINE).replace("<nPhis>2", "<nPhis>4294967295"), Place::Line(4), "4294967295 patches");
    refused(&sheet("Rows", NINE).replace("<nPhis>2", "<nPhis>60000"), Place::Line(8), "9 values");
    refused(&sheet("Rows", NINE).replace("<LowerTheta>30", "<LowerTheta>40"), Place::Line(4), "ring 1");
    refused("<scene/>", Place::Line(1), "<scene>");
    refused("<WindowElement></WindowElement>", Place::File, "no WavelengthData");
    let block_twice = sheet("Rows", NINE).replace("</WindowElement>", "");
    let (head, data) = block_twice.split_at(block_twice.find("<WavelengthData>").expect("data"));
    let data = data.replace("</Layer></Optical>", "");
    refused(
        &format!("{head}{data}{data}</Layer></Optical></WindowElement>"),
        Place::Line(12),
        "a second Reflection Back",
    );
}

/// What a file states twice must be the same, and its rings must cover the hemisphere.
#[test]
fn contradictions_and_radians_are_refused() {
    let text = sheet("Rows", NINE);
    let again = |change: &dyn Fn(String) -> String| {
        let definition =
            &text[text.find("<DataDefinition>").expect("a definition")..text.find("<WavelengthData>").expect("data")];
        text.replace("<WavelengthData>", &format!("{}<WavelengthData>", change(definition.to_string())))
    };
    assert_eq!(values(&again(&|same| same)), values(&text));
    refused(&again(&|same| same.replace("Rows", "Columns")), Place::Line(5), "another IncidentDataStructure");
    refused(&again(&|same| same.replace(">30<", ">40<")), Place::Line(5), "another basis \"mine\"");
    refused(&text.replace(">30<", ">0.6<").replace(">90<", ">1.5708<"), Place::Line(4), "rings up to 1.5708");
    refused(&text.replace(">90<", ">80<"), Place::Line(4), "rings up to 80");
    let data = &text[text.find("<WavelengthData>").expect("data")..text.find("</Layer>").expect("an end")];
    let second = format!("</Layer><Layer>{}</Layer>", data.replace("Reflection", "Transmission"));
    refused(&text.replace("</Layer>", &second), Place::Line(11), "values of a second Layer");
    assert_eq!(values(&text.replace("</Layer>", "</Layer><Layer><Material/></Layer>")), values(&text));
}

#[test]
fn trees_are_read_and_bad_braces_are_refused() {
    assert_eq!(values(&sheet("TensorTree3", "{ 0.5 }")), [0.5]);
    assert_eq!(values(&sheet("TensorTree3", "{1 2,3 4 5 6 7 8}")).len(), 8);
    assert_eq!(values(&sheet("TensorTree3", TREE)).len(), 15);
    let bad = [
        ("", "the end"),
        ("1", "1"),
        ("{", "the end"),
        ("{}", "0 values"),
        ("{1 2}", "2 values"),
        ("{1 2 3 4}", "4 values"),
        ("{1}}", "}"),
        ("{{1}}", "}"),
        ("{{1}{2}{3}{4}{5}{6}{7}{8}", "the end"),
        ("{{1}{2}{3}{4}{5}{6}{7}{8}{9}}", "{"),
        ("{{1}{2}{3}{4} 5 {6}{7}{8}}", "5"),
        ("{inf}", "inf"),
    ];
    for (braces, found) in bad {
        refused(&sheet("TensorTree3", braces), Place::Line(8), found);
    }
    refused(&sheet("TensorTree4", "{1 2 3 4 5 6 7 8}"), Place::Line(8), "8 values");
}

#[test]
fn deep_nesting_is_refused_without_a_deep_stack() {
    refused(&sheet("TensorTree4", &"{".repeat(1_000_000)), Place::Line(8), "nested deeper");
    refused(&sheet("TensorTree4", &"{ ".repeat(26)), Place::Line(8), "nested deeper");
    let elements = format!("<WindowElement>{}", "<a>".repeat(1_000_000));
    refused(&elements, Place::Line(1), "the end of the file");
}

#[test]
fn entities_of_the_file_are_not_expanded() {
    let mut bomb = String::from("<?xml version=\"1.0\"?>\n<!DOCTYPE b [<!ENTITY b0 \"ha\">");
    for level in 1..40 {
        bomb += &format!("<!ENTITY b{level} \"&b{0};&b{0};\">", level - 1);
    }
    bomb += "]>\n<WindowElement><Name>&b39;</Name></WindowElement>";
    refused(&bomb, Place::Line(3), "&b39;");
}

#[test]
fn hostile_input_does_no_harm() {
    for text in [sheet("Columns", NINE), sheet("TensorTree3", TREE)] {
        lobe_testing::damage::truncations(text.as_bytes(), |bytes| read(bytes).is_ok());
    }
}

#[test]
fn matrices_of_every_basis_survive_a_round_trip() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sheet.xml");
    for (incident, exit) in [
        (AngleBasis::full(), AngleBasis::full()),
        (AngleBasis::half(), AngleBasis::half()),
        (AngleBasis::quarter(), AngleBasis::quarter()),
        (AngleBasis::full(), AngleBasis::quarter()),
    ] {
        let count = incident.patches() * exit.patches();
        let values = (0..count).map(|at| (at as f32).sin() / 3.0).collect();
        let matrix = KlemsMatrix::new(incident, exit, values).expect("a matrix");
        let mut window = window::Blocks::default();
        window.set(Block::TransmissionFront, Component::Klems(matrix.clone()));
        window.set(Block::ReflectionBack, Component::Klems(matrix));
        let band = |name: &str| Band { wavelength: name.into(), window: window.clone() };
        let bands = vec![band("Visible"), band("CIE-X"), band("NIR")];
        let source = vec![("name".into(), "a < b & \"c\"".into()), ("manufacturer".into(), "d".into())];
        let written = Measured { data: Data { bands }, source, tis: Vec::new() };
        window_xml::write(&written.data, &written.source, &path).expect("a written file");
        let found = window_xml::read(&std::fs::read(&path).expect("the file"), &path);
        assert_eq!(found.as_ref(), Ok(&written));
    }
    let empty = window_xml::write(&Data::default(), &[], &folder.path().join("empty.xml"));
    assert!(empty.unwrap_err().to_string().contains("no block of values to write; expected a material that fits"));
    assert_eq!(folder.path().read_dir().expect("the folder").count(), 1, "one file and nothing half-written");
}

/// The material and the geometry of a sheet are put back as they were, to the character.
#[test]
fn material_and_geometry_are_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let (first, second) = (folder.path().join("first.xml"), folder.path().join("second.xml"));
    let material = "<Material>\n\t<Name>Awning &amp; Co</Name><Manufacturer>M</Manufacturer>\n\
                    <Thickness unit=\"Millimeter\">1.25</Thickness><DeviceType>Awning</DeviceType>\n\
                    <EmissivityFront>0.8</EmissivityFront></Material>";
    let geometry = "<Geometry format=\"MGF\"><MGFblock unit=\"meter\">\nxf -t 0 0 0\no plane\n</MGFblock></Geometry>";
    let own = "<Material><Name>a &amp; b</Name></Material>";
    let text = sheet("Columns", NINE).replacen(own, &format!("{material}{geometry}"), 1);
    assert!(text.contains(geometry), "{text}");
    std::fs::write(&first, &text).expect("written");
    let (_, mut document) = lobe_formats::open(&first).expect("a file");
    document.source.push((lobe_formats::RESAMPLED.into(), "from a -- file".into()));
    let writer = Format::WindowXml.writer().expect("a writer");
    (writer.write)(&document, &second).expect("written");
    let written = std::fs::read_to_string(&second).expect("the file");
    assert!(written.contains(material) && written.contains(geometry), "{written}");
    assert_eq!(written.matches("<Material>").count(), 1);
    let (_, back) = lobe_formats::open(&second).expect("a file");
    assert_eq!(back.kept, document.kept);
    let fact = |name: &str| back.source.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str());
    assert_eq!((fact("name"), fact("resampled")), (Some("Awning & Co"), Some("from a - - file")));
}
