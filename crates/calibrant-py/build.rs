//! Python provides its own symbols when it loads this library. On macOS the linker must be told not to look for them.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
