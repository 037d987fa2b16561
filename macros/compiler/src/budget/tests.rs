//! A panic is an error.

use quote::quote;

use super::without_panic;

#[test]
fn a_panic_is_an_error_that_asks_for_a_report() {
    let item = quote!(
        #[clebsch()]
        pub struct Body;
    );
    let errors = without_panic(&item, || std::panic::resume_unwind(Box::new("no such thing"))).unwrap_err();
    let text = errors.to_string();
    assert!(text.starts_with("error: this declaration has found a bug in clebsch: no such thing"), "{text}");
    assert!(text.contains("help: report it with the declaration"), "{text}");
    assert_eq!(without_panic(&item, || 1).ok(), Some(1));
}
