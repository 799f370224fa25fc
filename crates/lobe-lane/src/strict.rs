//! A backend whose multiply-add rounds twice, and the macro that declares the traits of backends.

use crate::{Kernel, Lanes};

/// Declares a trait of backends together with its implementation for [`Strict`], so that neither can be changed alone.
///
/// Items of the trait in braces are not forwarded: they have no default, or the strict form has its own, which the last
/// part gives. The functions of `handed_on` also belong to the trait, and `Strict` forwards each to the underlying
/// backend, whether or not it has a default: a backend that overrides a default also overrides it for its strict form.
/// Their names are listed in a constant, for a test.
macro_rules! backend_trait {
    (
        $(#[$meta:meta])*
        pub trait $trait:ident: $bound:ident $(+ $more:ident)* $(+ $lifetime:lifetime)? { $($own:tt)* }
        handed_on as $names:ident { $($handed_on:tt)* }
        strict { $($strict:tt)* }
    ) => {
        $(#[$meta])*
        pub trait $trait: $bound $(+ $more)* $(+ $lifetime)? {
            $($own)*
            $($handed_on)*
        }

        backend_trait! { @read [$trait $names { $($strict)* }] [] $($handed_on)* }
    };

    // One function at a time: those read so far, and those left. A default makes no difference.
    (@read $to:tt [$($read:tt)*]
        $(#[$meta:meta])*
        fn $name:ident $(<$(const $value:ident: usize),+ $(, $type:ident)?>)? (self $(, $arg:ident: $of:ty)* $(,)?) $(-> $out:ty)?;
        $($left:tt)*
    ) => {
        backend_trait! { @read $to
            [$($read)* { $name [$($(const $value: usize),+ $(, $type)?)?] [$($($value),+ $(, $type)?)?] ($($arg: $of),*) [$($out)?] }]
            $($left)* }
    };
    (@read $to:tt $read:tt
        $(#[$meta:meta])*
        fn $name:ident $(<$(const $value:ident: usize),+ $(, $type:ident)?>)? (self $(, $arg:ident: $of:ty)* $(,)?) $(-> $out:ty)? { $($body:tt)* }
        $($left:tt)*
    ) => {
        backend_trait! { @read $to $read
            fn $name $(<$(const $value: usize),+ $(, $type)?>)? (self $(, $arg: $of)*) $(-> $out)?;
            $($left)* }
    };
    (@read [$trait:ident $names:ident { $($strict:tt)* }] [$({
        $name:ident [$($generics:tt)*] [$($generic:ident),*] ($($arg:ident: $of:ty),*) [$($out:ty)?]
    })*]) => {
        impl<L: Lanes> $trait for Strict<L> {
            $($strict)*

            $(#[inline(always)]
            fn $name<$($generics)*>(self $(, $arg: $of)*) $(-> $out)? {
                self.0.$name::<$($generic),*>($($arg),*)
            })*
        }

        /// The functions that the strict form forwards to the underlying backend.
        #[doc(hidden)]
        pub const $names: &[&str] = &[$(stringify!($name)),*];
    };
}

pub(crate) use backend_trait;

/// The backend `L` with every multiply-add rounded twice: results have the same bits on every backend and width.
#[derive(Clone, Copy, Debug)]
pub struct Strict<L>(pub(crate) L);

impl<L: Lanes> Strict<L> {
    /// The underlying backend.
    pub fn inner(self) -> L {
        self.0
    }
}

/// Runs a kernel on the strict form of any backend.
pub(crate) struct Strictly<K>(pub(crate) K);

impl<K: Kernel> Kernel for Strictly<K> {
    type Out = K::Out;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> K::Out {
        self.0.run(Strict(lanes))
    }
}
