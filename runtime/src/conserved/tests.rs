use super::Conserved;
use std::format;
use std::string::ToString;

#[test]
fn values_are_found_by_name_and_printed_as_asked() {
    let momenta = Conserved::new(["a", "b"], [1.0 / 3.0, 2.0]);
    assert_eq!((momenta.get("b"), momenta.get("c")), (Some(2.0), None));
    assert_eq!(format!("{momenta:.2}"), "a = 0.33\nb = 2.00");
    assert!(momenta.iter().eq([("a", 1.0 / 3.0), ("b", 2.0)]));
    assert_eq!(Conserved::<f64, 0>::new([], []).to_string(), "");
}
