//! A library that Python loads finds Python's own names when it is loaded: on macOS the linker is told so.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
