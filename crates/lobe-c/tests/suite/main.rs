//! Tests of the header, and of programs in C and C++ that use it.

mod compiler;
mod header;
mod programs;
