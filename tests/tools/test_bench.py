"""The benchmark's arithmetic, its reader of OpenEXR and its scenes: test_bench.py KILN. Python's own library alone."""
import contextlib
import io
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "tools" / "bench"), str(ROOT / "tools")]
import bench
import errors
import pictures
import references
import runners
import scenes
import table


class Errors(unittest.TestCase):
    def test_relmse_of_a_known_difference(self):
        reference = errors.Reference()
        for _ in range(2):
            reference.add([1.0, 0.0, 0.3] * 1000)
        judge = errors.Judge(reference)
        trimmed, full, worst = judge.relmse([1.1, 0.0, 0.3] * 1000)
        self.assertAlmostEqual(full, 0.1**2 / 1.01 / 3)
        self.assertAlmostEqual(trimmed, full)
        self.assertAlmostEqual(worst, 0.001)
        self.assertEqual(judge.relative_noise(), 0)

    def test_trimming_leaves_out_the_worst_thousandth(self):
        reference = errors.Reference()
        for _ in range(2):
            reference.add([0.0] * 6000)
        picture = [0.01] * 6000
        picture[30:36] = [10.0] * 6  # two of two thousand pixels
        trimmed, full, worst = errors.Judge(reference).relmse(picture)
        self.assertAlmostEqual(trimmed, 0.01)
        self.assertAlmostEqual(full, (1998 * 0.01 + 2 * 1e4) / 2000)
        self.assertGreater(worst, 0.99)

    def test_the_noise_of_the_reference_is_taken_off(self):
        draw, sigma, count, values = random.Random(1), 0.2, 8, 9000
        noisy = lambda: [1 + draw.gauss(0, sigma) for _ in range(values)]
        reference = errors.Reference()
        for _ in range(count):
            reference.add(noisy())
        judge = errors.Judge(reference)
        _, full, _ = judge.relmse(noisy())
        self.assertAlmostEqual(full, sigma**2 / 1.01, delta=0.02 * sigma**2)
        self.assertAlmostEqual(judge.relative_noise(), sigma**2 / count / 1.01, delta=0.05 * sigma**2 / count)

    def test_intervals_cover_nineteen_times_of_twenty(self):
        draw, rounds, covered = random.Random(2), 2000, 0
        for _ in range(rounds):
            relmse = [0.02 * (1 + 0.1 * draw.gauss(0, 1)) for _ in range(6)]
            seconds = [3 * (1 + 0.03 * draw.gauss(0, 1)) for _ in range(6)]
            low, high = errors.efficiency(relmse, seconds).interval()
            covered += low <= 1 / (0.02 * 3) <= high
        self.assertAlmostEqual(covered / rounds, 0.95, delta=0.025)

    def test_a_ratio_carries_both_errors(self):
        a, b = errors.Estimate.of([2.0, 2.2, 1.8]), errors.Estimate.of([1.0, 1.1, 0.9])
        ratio = a.over(b)
        self.assertAlmostEqual(ratio.value(), 2)
        self.assertAlmostEqual(ratio.error, math.sqrt(2) * 0.1 / math.sqrt(3))
        low, high = ratio.interval()
        self.assertAlmostEqual(low * high, 4)

    def test_one_measurement_has_no_interval(self):
        self.assertEqual(errors.Estimate.of([5.0]).interval(), (0.0, math.inf))
        self.assertIsNone(errors.efficiency([0.0, 0.0], [1.0, 1.0]))

    def test_sampling_alone(self):
        self.assertAlmostEqual(errors.sampling_seconds(0.7 + 64 * 0.01, 0.7 + 0.01, 64), 0.64)


class Painter:
    """A renderer of an even grey with noise."""
    family, version = "painter", "painter 1"

    def __init__(self, grey):
        self.grey, self.count = grey, 0

    def render(self, spp, seed):
        draw = random.Random(seed)
        self.count += 1
        return [self.grey + 0.1 * draw.gauss(0, 1) for _ in range(3000)], {"seconds": 1.0}


class References(unittest.TestCase):
    def test_they_are_kept_gone_on_with_and_given_up(self):
        with tempfile.TemporaryDirectory() as name:
            folder, said = pathlib.Path(name), []
            scene = folder / "scene.glb"
            scene.write_bytes(b"a scene")
            get = lambda painter, seconds: references.Store(folder, 8, seconds, said.append).get(
                painter, "S1", scene, {})
            first = Painter(0.5)
            self.assertEqual((get(first, 0).count, first.count), (4, 4))
            again = Painter(0.5)
            reference = get(again, 0)
            self.assertEqual((reference.count, again.count), (4, 1))  # one to see whether it is still right
            self.assertAlmostEqual(sum(reference.mean()) / 3000, 0.5, delta=0.01)
            self.assertGreater(get(Painter(0.5), 0.2).count, 4)
            self.assertAlmostEqual(sum(get(Painter(0.9), 0).mean()) / 3000, 0.9, delta=0.01)
            self.assertIn("begun anew", said[-2])


class Table(unittest.TestCase):
    def row(self, name, error, seconds):
        efficiency = errors.efficiency([error, error * 1.1], [seconds, seconds])
        return {"renderer": name, "version": name, "samples_per_second": 1e6 / seconds, "seconds": seconds,
                "relmse": error, "worst_share": 0.03, "efficiency_trimmed": efficiency, "efficiency": efficiency}

    def test_the_best_peer_is_compared_with(self):
        rows = [self.row("kiln", 0.01, 1.0), self.row("cycles", 0.01, 4.0), self.row("mitsuba-independent", 0.02, 1.0)]
        ratio, peer = table.ratio(rows, "efficiency")
        self.assertEqual(peer, "mitsuba-independent")
        self.assertAlmostEqual(ratio.value(), 2)
        self.assertEqual(table.ratio(rows[:1], "efficiency"), (None, None))

    def test_markdown_and_json_are_written(self):
        result = {"scene": "S1", "settings": {}, "spp": 8, "rows": [self.row("kiln", 0.01, 1.0)], "pictures": ["kiln"],
                  "references_against_kiln": {}, "replay": {"render_share": 0.63, "samples_per_second": 5e6}}
        with tempfile.TemporaryDirectory() as folder:
            text = table.write(pathlib.Path(folder), {"cpu": "a processor", "threads": 2}, [result])
            self.assertIn("63 % of the replay", text)
            self.assertIn('"low"', (pathlib.Path(folder) / "bench.json").read_text())


class Program(unittest.TestCase):
    def test_kiln_renders_the_scenes_and_its_pictures_are_read(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            made, missing = scenes.make(folder, ["S1", "S6", "S8"], None, 20)
            self.assertEqual((sorted(made), missing), (["S1", "S6"], ["S8"]))
            kiln = runners.Kiln(KILN, 2)
            kiln.open(made["S1"])
            picture, took = kiln.render(16, 1)
            self.assertEqual(len(picture), 3 * 20 * 20)
            self.assertGreater(took["seconds"], 0)
            # Light that the lamp sends out and the walls keep: the same from run to run, red on the left.
            self.assertAlmostEqual(pictures.luminance(picture), 0.195, delta=0.02)
            red = lambda x: sum(picture[3 * (20 * y + x)] for y in range(20))
            green = lambda x: sum(picture[3 * (20 * y + x) + 1] for y in range(20))
            self.assertGreater(red(1), 2 * green(1))
            self.assertGreater(green(18), red(18))

    def test_compressed_blocks_are_read(self):
        with tempfile.TemporaryDirectory() as name:
            path, side = pathlib.Path(name) / "a.exr", 40
            asset = ROOT / "tests" / "data" / "gltf" / "pairs" / "unlit_a.gltf"
            subprocess.run([KILN, "render", asset, "--size", f"{side}x{side}", "--spp", "1", "--env", "none", "-q", "-o",
                            path], check=True)
            self.assertLess(path.stat().st_size, 12 * side * side)
            picture, width, height = pictures.read_exr(path)
            self.assertEqual((width, height), (side, side))
            self.assertTrue(all(0 <= v <= 1 for v in picture))
            self.assertEqual(picture[:3].tolist(), [0, 0, 0])  # nothing in the corner
            self.assertGreater(min(picture[3 * (side * side // 2 + side // 2):][:3]), 0.01)

    def test_a_png_is_written(self):
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "a.png"
            pictures.write_png(path, [[0.0] * 12, [1.0] * 12], 2, 2)
            self.assertEqual(path.read_bytes()[16:24], bytes((0, 0, 0, 4, 0, 0, 0, 2)))

    def test_options(self):
        self.assertEqual(bench.parse(["--quick"]).side, 64)
        self.assertEqual(bench.parse(["--quick", "--side", "32", "--scenes", "S1,S3"]).scenes, ["S1", "S3"])
        with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()) as told:
            bench.parse(["--scenes", "S9"])
        self.assertIn("S9 is not one of S1", told.getvalue())


if __name__ == "__main__":
    KILN = sys.argv.pop(1)
    unittest.main()
