"""The peers' side of the protocol: a process renders one scene as often as it is told to.

Lines of JSON: {"spp", "seed", "file"} comes in; {"seconds", "cpu_seconds", "peak"} goes out when the picture is written
as little-endian floats. The first line that goes out says how long the scene took to load."""
import json
import os
import resource
import sys
import time


def quiet():
    """Renderers talk on standard output: gives a stream that still reaches it."""
    told = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    return told


def serve(told, load_seconds, render):
    """render(spp, seed) gives rows of RGB from the top, as a numpy array."""
    print(json.dumps({"load_seconds": load_seconds}), file=told)
    for line in sys.stdin:
        order = json.loads(line)
        started, cpu = time.perf_counter(), time.process_time()
        picture = render(order["spp"], order["seed"])
        done = {"seconds": time.perf_counter() - started, "cpu_seconds": time.process_time() - cpu,
                "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024}
        with open(order["file"], "wb") as file:
            file.write(picture.astype("<f4").tobytes())
        print(json.dumps(done), file=told)
