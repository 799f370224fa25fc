//! The example runs, and checks what it renders.

#[path = "../../examples/render.rs"]
mod render;

#[test]
fn render_to_an_array() {
    render::main().unwrap();
}
