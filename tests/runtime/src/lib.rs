//! The tests in the sources of the runtime, compiled without optimisation.
//!
//! `clebsch` itself is compiled with optimisation, for the long tests of `clebsch-tests` that step by it. Its own tests step little, so that their
//! compilation takes most of their time: without optimisation it takes a third.
