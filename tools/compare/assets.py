"""Pictures of Khronos' sample assets, whose labels say how they should look."""
import pathlib
import subprocess

from PIL import Image

# Name, and what is to be seen.
ASSETS = [
    ("AttenuationTest", """The cubes of a column are as blue as the flat sample above them, in every row: kiln
measures the
path, so neither thickness nor its texture has to match the mesh, and a node's scale counts."""),
    ("TransmissionRoughnessTest", """From smooth to rough the rings behind the blocks blur, sooner where the ior is
higher;
at an ior of 1 nothing bends or blurs, whatever the roughness. The bottom row is opaque metal."""),
    ("dispersion-test", """No colour at dispersion 0, wider spectra to the right; at an ior of 1 the prisms cannot be
seen,
for nothing bends there."""),
    ("ClearCoatTest", """The middle column is the left one with the right one on top: a smooth highlight over a rough
base,
over a ribbed one ('Base normal map'), ribs in both, and ribs in the coat alone ('Coat normal map')."""),
    ("AnisotropyStrengthTest", """Highlights are round at strength 0 and stretch along the horizon row by row; to the
right
roughness hides it."""),
    ("AnisotropyDiscTest", """The discs show fans that open across the grooves, and fade into the plate as its
roughness comes
near theirs."""),
    ("SunglassesKhronos", """Blue reflections of the studio's lamps on dark teal lenses, and a bright metal frame."""),
    ("19_sheen", """Seven flat-shaded spheres of base 0.8: without sheen, with a sheen of roughness 0, then of 0.8
with factors
and textures; the fifth has a coloured one. Sheen on so bright a base takes about as much as it gives."""),
    ("20_specular", """Flat-shaded spheres of base 0.8 that differ in specular factor and colour, which on white
paint in an even
studio can hardly be seen: no factor or texture is mistaken for another's colour."""),
]


def find(folder, name):
    for path in (folder / f"{name}.glb", folder / name / f"{name}.gltf"):
        if path.exists():
            return path
    return None


def render(arguments):
    """The page's lines about the assets; none without a folder of them."""
    if not arguments.assets:
        return []
    lines = ["## Sample assets", "", "Rendered in the studio, unless a file has lights of its own."]
    for name, text in ASSETS:
        path = find(pathlib.Path(arguments.assets) / "gltf", name)
        if path is None:
            print(f"compare: no {name} under {arguments.assets}", flush=True)
            continue
        picture = arguments.folder / f"{name}.png"
        if not picture.exists():
            subprocess.run([arguments.kiln, "render", path, "-o", picture, "--size", "640x640", "--spp", "48",
                            "--noise", "0", "--quiet", "--orbit", "0,5"], check=True)
            print(f"compare: {name}", flush=True)
        target = pathlib.Path(__file__).resolve().parent.parent.parent / f"docs/images/compare/{name}.webp"
        Image.open(picture).convert("RGB").save(target, quality=80)
        lines += ["", f"**{name}.** " + text.replace("\n", " "), "", f"![{name}](images/compare/{name}.webp)"]
    return lines
