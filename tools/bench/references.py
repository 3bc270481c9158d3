"""Each renderer's own long reference of each scene: sums of independent renders, kept and gone on with."""
import array
import hashlib
import json
import time

from errors import Judge, Reference

SEED = 900_000  # of the first; measurements have smaller ones


def key_of(runner, path, settings):
    """A reference is good for this scene, these surroundings and this version. That a kiln of the same version renders
    otherwise is found by is_stale."""
    digest = hashlib.sha256(runner.version.encode())
    digest.update(path.read_bytes())
    if "env" in settings:
        digest.update((path.parent / settings["env"]["file"]).read_bytes())
    return digest.hexdigest()[:16]


class Store:
    def __init__(self, folder, spp, seconds, say):
        self.folder, self.spp, self.seconds, self.say = folder, spp, seconds, say
        folder.mkdir(parents=True, exist_ok=True)

    def load(self, base):
        """The reference and the seconds that it took."""
        try:
            told = json.loads(base.with_suffix(".json").read_text())
            numbers = array.array("d", base.with_suffix(".sums").read_bytes())
        except (OSError, ValueError):
            return Reference(), 0.0
        half = len(numbers) // 2
        return Reference(list(numbers[:half]), list(numbers[half:]), told["count"]), told["seconds"]

    def save(self, base, reference, seconds):
        numbers = array.array("d", reference.total)
        numbers.extend(reference.squares)
        base.with_suffix(".sums").write_bytes(numbers.tobytes())
        base.with_suffix(".json").write_text(json.dumps({"count": reference.count, "seconds": seconds}))

    def is_stale(self, runner, reference):
        """One render more must err by what one of the reference's did."""
        picture, _ = runner.render(self.spp, SEED - 1)
        judge = Judge(reference)
        return judge.relmse(picture)[0] > 2 * judge.relative_noise() * reference.count + 1e-6

    def get(self, runner, name, path, settings):
        base = self.folder / f"{name}.{runner.family}.{self.spp}.{key_of(runner, path, settings)}"
        reference, spent = self.load(base)
        if reference.count and self.is_stale(runner, reference):
            self.say(f"{name}: the kept reference of {runner.family} is not what it renders now; begun anew")
            reference, spent = Reference(), 0.0
        started = time.monotonic()
        before = spent
        while reference.count < 4 or spent < self.seconds:
            reference.add(runner.render(self.spp, SEED + reference.count)[0])
            spent = before + time.monotonic() - started
        if spent > before:
            self.save(base, reference, spent)
            self.say(f"{name}: reference of {runner.family}: {reference.count * self.spp} samples per pixel")
        return reference
