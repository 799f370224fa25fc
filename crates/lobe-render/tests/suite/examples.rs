//! Runs the example, which checks its own result.

#[path = "../../examples/render.rs"]
mod render;

#[test]
fn render_to_an_array() {
    render::main().unwrap();
}
