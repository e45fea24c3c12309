//! Widths, breaks and numbers of tables for people.

use super::*;

fn table() -> TextTable {
    let mut table = TextTable::new(1, ["device", "|θ\u{307}|"]);
    table.row(vec!["a|b".to_owned(), number(-0.25, 1)]);
    table.row(vec!["\u{5730}\u{9707}".to_owned(), number(None, 1)]);
    table
}

#[test]
fn rows_are_as_wide_as_a_terminal_shows_them() {
    for text in [table().markdown(), table().plain()] {
        let width = measure_text_width(text.lines().next().unwrap());
        assert!(text.lines().all(|line| measure_text_width(line) == width), "{text}");
    }
    assert_eq!((table().markdown().lines().count(), table().plain().lines().count()), (4, 3));
}

#[test]
fn a_table_wider_than_the_room_continues_below_with_the_first_words() {
    let mut table = TextTable::new(1, ["device", "peak", "impacts", "outcome"]);
    table.row(["pair", "0.25", "12", "safe"].map(str::to_owned).to_vec());
    let text = table.within(22);
    assert_eq!(text, "device  peak  impacts\npair    0.25       12\n\ndevice  outcome\npair       safe\n");
    // However narrow, nothing is lost.
    let narrow = table.within(1);
    assert!(["peak", "0.25", "impacts", "12", "outcome", "safe"].iter().all(|word| narrow.contains(word)), "{narrow}");
    assert_eq!(table.within(30), table.plain());
}

#[test]
fn words_and_numbers_are_never_broken() {
    let mut table = TextTable::new(1, ["device", "change, medians"]);
    table.row(["clutched pair".to_owned(), change(-0.3)].to_vec());
    for room in 17..40 {
        let text = table.within(room);
        assert!(text.lines().all(|line| measure_text_width(line) <= room), "{room}: {text}");
        let whole = ["clutched", "pair", "change,", "medians", "\u{2212}30 %"];
        assert!(whole.iter().all(|word| text.contains(word)), "{room}: {text}");
    }
    assert_eq!(table.within(17), "device    change,\n          medians\nclutched    \u{2212}30 %\npair\n");
}

#[test]
fn words_are_broken_after_hyphens_sooner_than_numbers_leave_their_columns() {
    let mut table = TextTable::new(2, ["device", "outcome", "first impact (s)"]);
    table.row(["clutched pair", "overturned-after-impact", "4.562"].map(str::to_owned).to_vec());
    for room in 29..60 {
        let text = table.within(room);
        assert!(text.lines().all(|line| measure_text_width(line) <= room), "{room}: {text}");
        assert!(["overturned-", "impact", "4.562"].iter().all(|piece| text.contains(piece)), "{room}: {text}");
    }
    let narrow = [
        "device    outcome       first",
        "                       impact",
        "                          (s)",
        "clutched  overturned-   4.562",
        "pair      after-",
        "          impact",
    ];
    assert_eq!(table.within(29).lines().collect::<Vec<_>>(), narrow);
    assert_eq!(pieces("a 2.5e-3 and -1, --set x-y").count(), 6);
}

#[test]
fn people_see_the_columns_that_have_a_heading() {
    struct Two;
    impl Table for Two {
        fn columns(&self) -> Vec<Column> {
            vec![
                Column::text("device").shown("device", Shown::Digits(0)),
                Column::number("hidden"),
                Column::number("ratio").or_nothing().shown("change", Shown::Change),
                Column::number("b").shown("β", Shown::Digits(2)),
            ]
        }
        fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
            writer.row(&["pair".into(), 7.0.into(), 0.7.into(), (-0.128).into()])?;
            writer.row(&["none".into(), 7.0.into(), Value::Nothing, f64::NAN.into()])
        }
    }
    let text = TextTable::of(&Two).unwrap().plain();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split("  ").map(str::trim).collect()).collect();
    let rows: Vec<Vec<&str>> = rows.into_iter().map(|row| row.into_iter().filter(|cell| !cell.is_empty()).collect()).collect();
    assert_eq!(rows, [["device", "change", "β"], ["pair", "\u{2212}30 %", "\u{2212}0.13"], ["none", "-", "-"]]);
}

#[test]
fn markdown_escapes_bars_and_aligns_numbers_to_the_right() {
    let text = table().markdown();
    assert!(text.contains("a\\|b") && text.lines().nth(1).unwrap().ends_with("-:|"), "{text}");
}

#[test]
fn what_is_no_number_is_a_dash() {
    assert_eq!([number(1.25, 1), number(Some(-2.0), 2)], ["1.2", "-2.00"]);
    assert_eq!([number(None, 1), number(f64::NAN, 1), number(f64::INFINITY, 1)], ["-", "-", "-"]);
}

/// A factor of a power law may have any size, and as 0.000 says nothing.
#[test]
fn numbers_of_any_size_keep_their_figures() {
    let of = |value: f64| in_figures(value, 3);
    assert_eq!([2.8874, 0.1234, 0.0, 1234.5678].map(of), ["2.887", "0.123", "0.000", "1234.568"]);
    assert_eq!([0.099_96, 0.093_04, 4.3e-4, 4.304e-7, -2.5e9].map(of), ["0.100", "0.0930", "0.000430", "4.30e-7", "-2.50e9"]);
    assert_eq!([f64::NAN, f64::INFINITY].map(of), ["-", "-"]);
}

#[test]
fn changes_have_a_sign_and_no_negative_zero() {
    assert_eq!([-0.3, 0.004, 0.25, -0.004].map(change), ["\u{2212}30 %", "0 %", "+25 %", "0 %"]);
    assert_eq!([0.1234, -0.5, -0.0001].map(change_in_tenths), ["+12.3 %", "\u{2212}50.0 %", "0 %"]);
    assert_eq!([change(None), change(f64::INFINITY), change_in_tenths(f64::NAN)], ["-", "-", "-"]);
}
