//! The header, and programs in C and C++ that use it.

mod compiler;
mod header;
mod programs;
