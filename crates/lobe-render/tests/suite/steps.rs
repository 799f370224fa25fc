//! Rendering a piece at a time.

use std::sync::Arc;

use lobe_render::integrator::{Bdpt, Integrator, Path};
use lobe_render::shader::{Backend, Lambert};
use lobe_render::stage::{Form, Lighting, Sky, stage};
use lobe_render::{Film, Filter, Rect, Rgb, Settings, render, render_until};

/// In pieces or as a whole, the picture is the same bits.
#[test]
fn pieces_are_the_whole() {
    let backend = Backend::scalar();
    let lighting = Lighting { toward: [-0.5, 0.7, 0.6], sky: Sky::Studio };
    let (world, camera) = stage(Arc::new(Lambert::new([0.5; 3], backend)), Form::Ball, &lighting, backend).unwrap();
    let window = Rect { x: 0, y: 0, width: 80, height: 70 };
    for integrator in [Arc::new(Path { depth: 3, limit: 4.0 }) as Arc<dyn Integrator>, Arc::new(Bdpt::default())] {
        let settings = Settings::<Rgb> {
            camera,
            size: [80, 70],
            window,
            filter: Filter::Tent,
            integrator,
            samples: 0..3,
            backend,
            threads: 1,
            time: None,
        };
        let (whole, _) = render(&world, &settings, Film::new(window), |_| true).unwrap();
        let (mut film, mut calls) = (Film::new(window), 0);
        loop {
            let step = render_until(&world, &settings, film, || false).unwrap();
            (film, calls) = (step.film, calls + 1);
            if step.is_done {
                break;
            }
            assert!(calls < 100, "no end");
        }
        assert!(calls > 2, "{calls} calls");
        assert!(film.colours().eq(whole.colours()));
    }
}
