"""The lock of the interpreter, threads that share a material, and Ctrl-C."""

import concurrent.futures
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import directions

import lobe_bsdf


def test_threads_share_a_material(conductor):
    sampler = conductor.sampler()
    w = directions(30_000, 1)
    u = np.random.default_rng(0).random((30_000, 2))
    expected = conductor.eval(w, w[::-1]).tobytes(), sampler.sample(w, u)[2].tobytes()

    def work(_):
        return conductor.eval(w, w[::-1]).tobytes(), sampler.sample(w, u)[2].tobytes()

    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        assert all(found == expected for found in pool.map(work, range(32)))


def test_the_lock_is_released(cloth):
    w = directions(1_500_000, 1)
    out = np.zeros((len(w), 3), np.float32)
    counted = 0
    done = threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.0005)

    thread = threading.Thread(target=count)
    thread.start()
    time.sleep(0.01)
    before, begun = counted, time.monotonic()
    cloth.eval(w, w[::-1], out=out)
    during, taken = counted - before, time.monotonic() - begun
    done.set()
    thread.join()
    if taken < 0.01:
        pytest.skip("this machine is too fast to count anything meanwhile")
    # With the lock held, it could not count at all.
    assert during >= 3


SCRIPT = """
import signal, sys, time
import numpy as np
import lobe_bsdf
# It is ignored in what a shell runs in the background.
signal.signal(signal.SIGINT, signal.default_int_handler)
material = lobe_bsdf.open(sys.argv[1])
w = np.zeros((6_000_000, 3), np.float32); w[:, 2] = 1
out = np.zeros((len(w), 3), np.float32)
works = {
    "eval": lambda: [material.eval(w, w, out=out) for _ in range(1000)],
    "albedo": lambda: material.albedo(np.linspace(0, 1.5, 100_000), tolerance=1e-9),
    "render": lambda: lobe_bsdf.render(sys.argv[2], samples=100_000),
}
print("begun", flush=True)
try:
    works[sys.argv[3]]()
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


@pytest.mark.skipif(os.name == "nt", reason="SIGINT is sent to a process")
@pytest.mark.parametrize("work", ["eval", "albedo", "render"])
def test_ctrl_c_ends_work(fixtures, work):
    scene = str(fixtures / "scenes" / "cloth-metal-paint.toml")
    command = [sys.executable, "-c", SCRIPT, str(fixtures / "conductor-7x8x13.ddr"), scene, work]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "begun\n"
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        begun = time.monotonic()
        try:
            out, _ = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            process.kill()
            raise
    assert out == "interrupted\n"
    assert process.returncode == 0
    assert time.monotonic() - begun < 30


def test_signals_do_not_concern_other_threads(conductor):
    found = []
    thread = threading.Thread(target=lambda: found.append(conductor.albedo(0.5)))
    thread.start()
    thread.join()
    assert len(found) == 1
    assert lobe_bsdf.backends()
