"""The protocol of peers. A peer prints `ready VERSION` once, then answers each line of its input:

    run TASK TIMES      the least processor time of this many runs, in seconds
    values TASK FILE    `written`, after writing the results of a run to FILE, as little-endian f32

Preparing a task is not timed.
"""

import ctypes
import gc
import pathlib
import sys
import time

import numpy as np


def choose_lanes(wide):
    """Makes Dr.Jit compile for AVX2, which the compared library uses; or, if `wide`, leaves the choice to it and ends the
    program if its vectors are not wider. Call it after a variant that needs LLVM has been chosen."""
    import drjit

    # Functions that its header declares, by their mangled C++ names.
    library = next(pathlib.Path(drjit.__file__).parent.glob("libdrjit-core.*"))
    core = ctypes.CDLL(str(library))
    lanes = getattr(core, "_Z21jit_llvm_vector_widthv")
    target = getattr(core, "_Z19jit_llvm_set_targetPKcS0_j")
    target.argtypes = [ctypes.c_char_p, ctypes.c_char_p, ctypes.c_uint32]
    if wide and lanes() <= 8:
        sys.exit("this processor has no vectors wider than those of AVX2")
    if not wide and lanes() > 8:
        # AVX2 with gathers that LLVM considers fast, as on all processors with AVX-512. For older ones it splits gathers,
        # and `measured` takes four times as long.
        target(b"skylake", None, 8)
        assert lanes() == 8


def serve(version, make, warm_runs):
    """Answers requests with `make(TASK)`, which has `run()` and `values()`, and runs `warm_runs` times before it is timed."""
    ready = {}

    def prepared(name):
        if name not in ready:
            ready[name] = make(name)
            for _ in range(warm_runs):
                ready[name].run()
        return ready[name]

    print("ready", version, flush=True)
    gc.disable()
    for line in sys.stdin:
        what, name, argument = line.rstrip("\n").split(" ", 2)
        contestant = prepared(name)
        if what == "run":
            least = float("inf")
            for _ in range(int(argument)):
                start = time.process_time_ns()
                contestant.run()
                least = min(least, time.process_time_ns() - start)
            print(least * 1e-9, flush=True)
        else:
            np.asarray(contestant.values(), "<f4").tofile(argument)
            print("written", flush=True)
