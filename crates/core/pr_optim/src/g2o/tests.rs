use super::*;
use pr_geom::SE2;

const SMALL: &str = "\
# three poses
VERTEX_SE2 7 0 0 0
VERTEX_SE2 3 1.5 0 0.1
VERTEX_XY 9 4 4
VERTEX_SE2 5 2 1 3.2

EDGE_SE2 7 3 1 0 0 10 0 0 10 0 20
EDGE_SE2 3 5 1 1 0.2 10 1 0 10 0 20
EDGE_SE2_XY 3 9 1 1 5 0 5
";

fn text_of(file: &G2oFile) -> String {
    String::from_utf8(file.to_bytes()).unwrap()
}

fn error_of(text: impl AsRef<[u8]>) -> (usize, G2oProblem) {
    let error = G2oFile::parse(text).unwrap_err();
    (error.line, error.problem)
}

#[test]
fn vertices_and_edges_are_read_by_id() {
    let file = G2oFile::parse(SMALL).unwrap();
    assert_eq!(file.problem.node_count(), 3);
    assert_eq!(file.problem.fixed(), [true, false, false]);
    assert_eq!(file.id_of(2), 5);
    let factor = file.problem.factors()[1];
    assert_eq!((factor.from, factor.to), (1, 2));
    assert_eq!(factor.information[(1, 0)], 1.0);
}

#[test]
fn unknown_records_are_counted_and_written_back() {
    let file = G2oFile::parse(SMALL).unwrap();
    let kept: Vec<_> = file.kept_records().into_iter().collect();
    let named = |name: &str| (name.to_owned(), 1);
    assert_eq!(kept, [named("EDGE_SE2_XY"), named("VERTEX_XY")]);
    let written = text_of(&file);
    for line in [
        "# three poses",
        "VERTEX_XY 9 4 4",
        "EDGE_SE2_XY 3 9 1 1 5 0 5",
        "",
    ] {
        assert!(written.lines().any(|other| other == line), "{line}");
    }
    assert_eq!(written.lines().count(), SMALL.lines().count());
}

#[test]
fn poses_survive_writing_and_reading_with_all_their_bits() {
    let mut file = G2oFile::parse(SMALL).unwrap();
    file.problem.poses_mut()[1] = SE2::new(0.1 + 0.2, -1.0 / 3.0, 1e-17);
    let again = G2oFile::parse(file.to_bytes()).unwrap();
    assert_eq!(again.problem.poses(), file.problem.poses());
}

#[test]
fn fix_names_the_vertex_that_holds_the_gauge() {
    let file = G2oFile::parse(format!("FIX 5\n{SMALL}")).unwrap();
    assert_eq!(file.problem.fixed(), [false, false, true]);
}

#[test]
fn errors_name_the_line() {
    let (line, problem) = error_of("VERTEX_SE2 0 0 0\n");
    assert_eq!(line, 1);
    assert!(matches!(problem, G2oProblem::FieldCount { found: 3, .. }));
    let (line, problem) = error_of("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 0 1 0 0\n");
    assert_eq!(line, 2);
    assert!(matches!(
        problem,
        G2oProblem::DuplicateVertex { first_line: 1, .. }
    ));
    let (line, problem) = error_of(format!("{SMALL}EDGE_SE2 7 99 0 0 0 1 0 0 1 0 1\n"));
    assert_eq!(line, 10);
    assert_eq!(problem, G2oProblem::UnknownVertex { id: 99 });
    let (line, problem) = error_of(format!("{SMALL}EDGE_SE2 7 7 0 0 0 1 0 0 1 0 1\n"));
    assert_eq!((line, problem), (10, G2oProblem::SelfEdge { id: 7 }));
    let (_, problem) = error_of(format!("{SMALL}EDGE_SE2 7 5 0 nan 0 1 0 0 1 0 1\n"));
    assert!(matches!(problem, G2oProblem::NotANumber { .. }));
    let (_, problem) = error_of(format!("{SMALL}EDGE_SE2 7 5 0 0 0 1 2 0 1 0 1\n"));
    assert_eq!(problem, G2oProblem::IndefiniteInformation);
    let (line, problem) = error_of(format!("{SMALL}VERTEX_SE2 1 0 0 0\n"));
    assert_eq!((line, problem), (10, G2oProblem::Disconnected { id: 1 }));
    assert_eq!(error_of("").1, G2oProblem::Empty);
    let (line, problem) = error_of(format!("{SMALL}FIX\n"));
    assert_eq!((line, problem), (10, G2oProblem::EmptyFix));
}

#[test]
fn nodes_and_factors_have_their_lines() {
    let file = G2oFile::parse(SMALL).unwrap();
    assert_eq!([0, 1, 2].map(|node| file.line_of(node)), [2, 3, 5]);
    assert_eq!([0, 1].map(|factor| file.line_of_factor(factor)), [7, 8]);
}

#[test]
fn every_line_keeps_its_end() {
    let text = "VERTEX_SE2 0 0 0 0\r\nVERTEX_XY 9 4 4 \r\n# unix\nVERTEX_SE2 1 1 0 0\n\
                EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1";
    assert_eq!(text_of(&G2oFile::parse(text).unwrap()), text);
    let ends_in_a_vertex = "VERTEX_SE2 0 0 0 0\r\n# no end\nVERTEX_SE2 1 0 0 0";
    let file = format!("EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\r\n{ends_in_a_vertex}");
    assert_eq!(text_of(&G2oFile::parse(&file).unwrap()), file);
}

#[test]
fn a_byte_order_mark_is_skipped() {
    for marks in ["\u{feff}", "\u{feff}\u{feff}"] {
        let file = G2oFile::parse(format!("{marks}{}", &SMALL["# three poses\n".len()..])).unwrap();
        assert_eq!(file.line_of(0), 1);
        assert!(text_of(&file).starts_with("VERTEX_SE2 7 0 0 0\n"));
    }
}

#[test]
fn only_a_comment_may_be_in_another_encoding() {
    // "Größe" in Latin-1.
    let latin = b"Gr\xF6\xDFe";
    let with = |line: &[u8]| [SMALL.as_bytes(), line, latin, b"\n"].concat();
    let commented = with(b"  # ");
    let file = G2oFile::parse(&commented).unwrap();
    assert_eq!(file.kept_records().len(), 2);
    assert!(file.to_bytes().ends_with(b"  # Gr\xF6\xDFe\n"));
    assert_eq!(error_of(with(b"TAG ")), (10, G2oProblem::NotText));
}
