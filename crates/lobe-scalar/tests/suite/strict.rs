//! A strict form forwards every method, whether or not it has a default.

use std::cell::RefCell;

use lobe_lane::{Block, Kernel, LANES_HANDED_ON, Lanes, TEXELS_HANDED_ON, Texels};
use lobe_scalar::Scalar;

type Four = Scalar<4>;
type F = <Four as Lanes>::F;
type I = <Four as Lanes>::I;
type M = <Four as Lanes>::M;
type Quad = <Four as Texels>::Quad;
type Oct = <Four as Texels>::Oct;

thread_local! {
    static CALLED: RefCell<Vec<&'static str>> = const { RefCell::new(Vec::new()) };
}

/// A backend that overrides every method to record its name.
#[derive(Clone, Copy, Debug)]
struct Spy;

/// Methods with arguments to call them with.
macro_rules! spied {
    ($trait:ident { $($others:tt)* } $calls:ident:
        $(fn $name:ident
            $(<$(const $value:ident: usize = $number:literal),+ $(, $type:ident = $actual:ty)?>)?
            ($($arg:ident: $of:ty = $example:expr),*) $(-> $out:ty)?;)*
    ) => {
        impl $trait for Spy {
            $($others)*

            $(fn $name $(<$(const $value: usize),+ $(, $type)?>)? (self $(, $arg: $of)*) $(-> $out)? {
                CALLED.with_borrow_mut(|called| called.push(stringify!($name)));
                Scalar::<4>.$name $(::<$($value),+ $(, $type)?>)? ($($arg),*)
            })*
        }

        /// The names of all methods, each of which has been called once.
        fn $calls() -> &'static [&'static str] {
            let lanes = Spy.strict();
            $(let _ = lanes.$name $(::<$($number),+ $(, $actual)?>)? ($($example),*);)*
            &[$(stringify!($name)),*]
        }
    };
}

spied! { Texels {
        type Quad = Quad;
        type Oct = Oct;

        fn scalar_mul_add(self, _: f32, _: f32, _: f32) -> f32 {
            unreachable!("the strict form multiplies and adds by itself")
        }
        fn quad_mul_add(self, _: Quad, _: Quad, _: Quad) -> Quad {
            unreachable!("the strict form multiplies and adds by itself")
        }
        fn oct_mul_add(self, _: Oct, _: Oct, _: Oct) -> Oct {
            unreachable!("the strict form multiplies and adds by itself")
        }
    } call_texels:
    fn quad_load(src: &[f32] = &[0.0; 4]) -> Quad;
    fn quad_store(dst: &mut [f32] = &mut [0.0; 4], x: Quad = Scalar::<4>.quad_splat(1.0));
    fn quad_corners<const N: usize = 2>(block: &Block<'_, N, 4> = &Block::new(&[0.0; 8], [0, 4]), base: usize = 0) -> [Quad; N];
    fn quad_corners_half<const N: usize = 2>(block: &Block<'_, N, 4, u16> = &Block::new(&[0; 8], [0, 4]), base: usize = 0) -> [Quad; N];
    fn quad_splat(x: f32 = 1.0) -> Quad;
    fn quad_max(a: Quad = Scalar::<4>.quad_splat(1.0), b: Quad = Scalar::<4>.quad_splat(1.0)) -> Quad;
    fn oct_load(src: &[f32] = &[0.0; 8]) -> Oct;
    fn oct_store(dst: &mut [f32] = &mut [0.0; 8], x: Oct = Scalar::<4>.oct_splat(1.0));
    fn oct_splat(x: f32 = 1.0) -> Oct;
    fn oct_corners<const N: usize = 2>(block: &Block<'_, N, 8> = &Block::new(&[0.0; 16], [0, 8]), base: usize = 0) -> [Oct; N];
    fn oct_corners_half<const N: usize = 2>(block: &Block<'_, N, 8, u16> = &Block::new(&[0; 16], [0, 8]), base: usize = 0) -> [Oct; N];
    fn oct_max(a: Oct = Scalar::<4>.oct_splat(1.0), b: Oct = Scalar::<4>.oct_splat(1.0)) -> Oct;
    fn oct_halves(x: Oct = Scalar::<4>.oct_splat(1.0)) -> [Quad; 2];
    fn oct_count_le(knots: Oct = Scalar::<4>.oct_splat(1.0), x: f32 = 1.0) -> u32;
}

spied! { Lanes {
        type F = F;
        type I = I;
        type M = M;
        type Narrow = Self;

        const LANES: usize = 4;
        const NAME: &'static str = "spy";
        const FUSED: bool = true;
        const PERMUTES: bool = true;

        fn vectorize<K: Kernel>(self, kernel: K) -> K::Out {
            kernel.run(self)
        }
        fn narrow(self) -> Self {
            self
        }
        fn mul_add(self, _: F, _: F, _: F) -> F {
            unreachable!("the strict form multiplies and adds by itself")
        }
    } call_lanes:
    fn splat(x: f32 = 1.0) -> F;
    fn first_four(x: [f32; 4] = [1.0; 4]) -> F;
    fn splat_int(x: i32 = 1) -> I;
    fn iota() -> I;
    fn first_n(n: usize = 1) -> M;
    fn select(mask: M = Scalar::<4>.first_n(1), a: F = Scalar::<4>.splat(1.0), b: F = Scalar::<4>.splat(1.0)) -> F;
    fn select_int(mask: M = Scalar::<4>.first_n(1), a: I = Scalar::<4>.iota(), b: I = Scalar::<4>.iota()) -> I;
    fn select_negative(sign: I = Scalar::<4>.iota(), a: F = Scalar::<4>.splat(1.0), b: F = Scalar::<4>.splat(1.0)) -> F;
    fn load(src: &[f32] = &[0.0; 4]) -> F;
    fn store(dst: &mut [f32] = &mut [0.0; 4], x: F = Scalar::<4>.splat(1.0));
    fn load_int(src: &[i32] = &[0; 4]) -> I;
    fn store_int(dst: &mut [i32] = &mut [0; 4], x: I = Scalar::<4>.iota());
    fn load_partial(src: &[f32] = &[0.0; 3]) -> F;
    fn store_partial(dst: &mut [f32] = &mut [0.0; 3], x: F = Scalar::<4>.splat(1.0));
    fn store_int_partial(dst: &mut [i32] = &mut [0; 3], x: I = Scalar::<4>.iota());
    fn prefetch<const LINES: usize = 1, T = f32>(memory: &[T] = &[0.0], at: usize = 0);
    fn load_xyz(src: &[[f32; 3]] = &[[0.0; 3]; 4]) -> [F; 3];
    fn gather(table: &[f32] = &[1.0], index: I = Scalar::<4>.iota()) -> F;
    fn gather_pair(table: &[[f32; 2]] = &[[1.0; 2]], index: I = Scalar::<4>.iota()) -> [F; 2];
    fn gather_quads<const N: usize = 1>(block: &Block<'_, N, 4> = &Block::new(&[0.0; 8], [0]), base: I = Scalar::<4>.iota()) -> [[F; 4]; N];
    fn gather_quads_at<const N: usize = 1>(block: &Block<'_, N, 4> = &Block::new(&[0.0; 8], [0]), bases: &[i32] = &[0; 4]) -> [[F; 4]; N];
    fn gather_quads_half<const N: usize = 1>(block: &Block<'_, N, 4, u16> = &Block::new(&[0; 8], [0]), base: I = Scalar::<4>.iota()) -> [[F; 4]; N];
    fn oct_lookup(table: Oct = Scalar::<4>.oct_splat(1.0), index: I = Scalar::<4>.iota()) -> F;
    fn look_up<const N: usize = 1>(table: [F; N] = [Scalar::<4>.splat(1.0)], index: I = Scalar::<4>.iota()) -> F;
    fn descend(node: I = Scalar::<4>.iota(), difference: F = Scalar::<4>.splat(1.0)) -> I;
    fn uniform(index: I = Scalar::<4>.iota(), mask: M = Scalar::<4>.first_n(1)) -> (bool, i32);
    fn extract_int(x: I = Scalar::<4>.iota(), lane: usize = 0) -> i32;
    fn splat_xyz(vector: [f32; 3] = [1.0; 3]) -> [F; 3];
    fn extract_xyz(vectors: [F; 3] = [Scalar::<4>.splat(1.0); 3], lane: usize = 0) -> [f32; 3];
    fn extract(x: F = Scalar::<4>.splat(1.0), lane: usize = 0) -> f32;
}

#[test]
fn overridden_methods_are_reached_through_the_strict_form() {
    let all = [(call_texels(), TEXELS_HANDED_ON), (call_lanes(), LANES_HANDED_ON)];
    let called = CALLED.take();
    for (methods, handed_on) in all {
        for name in handed_on {
            assert!(methods.contains(name), "`{name}` is missing from this test");
        }
        for name in methods {
            assert!(called.contains(name), "`{name}` of the strict form does not reach the backend");
        }
    }
}

#[test]
fn the_strict_form_has_its_own_multiply_adds() {
    let lanes = Spy.strict();
    let (x, four, eight) = (lanes.splat(2.0), lanes.quad_splat(2.0), lanes.oct_splat(2.0));
    assert_eq!(lanes.extract(lanes.mul_add(x, x, x), 3), 6.0);
    assert_eq!(lanes.scalar_mul_add(2.0, 2.0, 2.0), 6.0);
    let mut found = [0.0; 8];
    lanes.oct_store(&mut found, lanes.oct_mul_add(eight, eight, eight));
    assert_eq!(found, [6.0; 8]);
    lanes.quad_store(&mut found, lanes.quad_mul_add(four, four, four) + four);
    assert_eq!(found[..4], [8.0; 4]);
}
