"""What docs/compare-materials.md says around its tables, and which differences it explains."""

HEAD = """
# kiln's materials beside Mitsuba's and Cycles'

Written by `script/compare-materials`, which renders everything on this page: change the script, not the page.

A sphere of radius 1 (65,000 triangles with exact normals, the same for all), seen by an orthographic camera, 64 × 64
pixels, in one of two worlds: 'white' is 1 everywhere, so that what comes back is the share of light that is not lost;
'boxes' is a grey room with a white and a warm soft box. kiln takes 4 × 64 samples a pixel, Mitsuba 3 and Cycles
4 × 32 (Mitsuba's glass here 4 × 64), each of the four with a seed of its own. Figures are means over all pixels that see nothing but the sphere; ± is half of the
95 % confidence interval, by Student's t of the four. A ratio is that of the colour channel which is furthest off.

**Formula** stands for `tools/compare/exact.py`: the same mean by quadrature from the formulas of the papers, with no
renderer, no code and no table of kiln's. It also knows the forms that Mitsuba and Cycles use, so where models are
different by intent, it says by how much: 'computed 1.15' means that kiln's formula over the peer's is 1.15.

A verdict is 'same' where the ratio is 1, and 'as computed' where it is the computed one, within 2 % or the confidence
interval; 'note 2' where it is off and note 2 says why, in bounds that the script checks; else it is **unexplained**.
"""

ABOUT = {
    "conductor": """
Conventions first: direction and scale of the environment, camera, Schlick's Fresnel term. Mitsuba interpolates the
environment between texels, which moves the edges of the soft boxes by half a texel: half a percent here.
""",
    "metal": """
kiln's metal is GGX with height-correlated Smith shadowing, Schlick's Fresnel term with F90 = 1, and a wide lobe for
light
that is reflected more than once (Kulla and Conty 2017). Mitsuba's `principled` has the product of two G1 and single
scattering alone, so it darkens with roughness: in the white world a white metal of roughness 1 returns less than half.
Cycles (Multiscatter GGX) returns all, as kiln, but puts it into the lobe itself (Turquin 2019) where kiln has a wide
one:
a lamp seen at grazing angles makes the difference. All three agree at low roughness, where none of this matters, and
each
is where its own formula says.
""",
    "dielectric": """
Metalness 0 and 0.5 over a saturated base. Cycles' Principled BSDF has the exact Fresnel term of the ior, kiln glTF's
Schlick, which is a fifth lower at 45° to 60°; it also weakens the base by what the coat reflects towards the viewer
alone,
where kiln's base is reciprocal. Mitsuba's `principled` has Disney's retro-reflective diffuse lobe and is left out.
""",
    "glass": """
A solid sphere of glass with an even roughness (`roughdielectric`; Glass BSDF with Multiscatter GGX). Smooth glass is
known exactly. Rough glass in the white world must come out as 1, and kiln's does within half a percent or its
noise; Mitsuba's loses the light that microfacets scatter more than once, at every one of many crossings.
kiln's noise is the largest of the three at an ior of 2 and a roughness of 1: single pixels of 64 samples reach 300 in
the white world, for inside of rough glass some directions are drawn much too rarely for the light that they carry.
""",
    "thin": """
glTF's thin wall is one interface, which passes 1 − F. Mitsuba's `thindielectric` is a plate with two, and reflects
2F/(1 + F). Both are a geometric series for a shell, so the ratio is computed.
""",
    "absorption": """
KHR_materials_volume against a homogeneous medium without scattering, inside of a smooth boundary of ior 1 and 1.5; the
formula is Beer's law along the chords of the sphere, and the series of internal reflections.
""",
    "scattering": """
KHR_materials_volume_scatter with an extinction of 2 per metre, at single-scattering albedos a and anisotropies g of
Henyey and Greenstein's function, against `volpath` and Cycles' volumes. The multiscatterColor of each case is the
one that
stands for a.
""",
    "clearcoat": """
A clear coat of ior 1.5 on a dark red Lambert surface. Cycles' coat has the exact Fresnel term and scales the base by
what
the coat reflects towards the viewer; kiln's has Schlick's, as KHR_materials_clearcoat asks for, and a reciprocal base.
Mitsuba's `principled` has a clear coat of GTR1 at a quarter of the strength: not the same model.
""",
    "sheen": """
KHR_materials_sheen is the Charlie lobe. Cycles' sheen is another model, fibres by linearly transformed cosines
(Zeltner,
Burley and Chiang 2022), with another meaning of roughness: the pictures show how far apart they are. What can be
checked is
the formula, which is the extension's, with the bounds that `render/bsdf/lobes/sheen.h` states.
""",
    "anisotropy": """
A white metal with alpha = mix(roughness², 1, strength²) along u, against `roughconductor` with the same alpha_u and
alpha_v. Its compensation of multiple scattering is compared with exactly what microfacets miss, spread as kiln's wide
lobe is; in the white world the right answer is 1.
""",
    "translucency": """
A closed shell of a thin diffuse wall, with the share of light that goes through; Cycles' Diffuse and Translucent
BSDFs mixed
by the same share. Light passes in and out and to and fro inside.
""",
    "iridescence": """
A film of ior 1.33 and of 200 to 600 nm on a dark dielectric and on copper, roughness 0.1. Cycles has a film on its
Principled
BSDF by the same paper (Belcour and Barla 2017), evaluated for light of three bands and with complex indices of metals.
""",
}

# Grids, peers, what case.light must match, the least and the largest ratio that is explained, and why.
NOTES = [
    (("glass",), ("mitsuba",), "", 1.02, 6.0, """Rough glass of Mitsuba loses the light that microfacets scatter more
than once.
In the white world, where 1 is right, kiln returns 1 and Mitsuba the ratio's inverse; under boxes the ratio is of
that size.
At roughness 0 and 0.1 nothing is lost, and the two agree."""),
    (("glass",), ("cycles",), "", 0.7, 0.985, """Cycles gives the missing light back to the lobe itself, which stays
as narrow as it
was, where kiln spreads it over both hemispheres; see rough metal, where the formula shows the same. At roughness 0
and 0.1
they agree. This one is reasoned, not computed: no formula here follows light through a rough sphere."""),
    (("sheen",), ("cycles",), "", 0.2, 5.0, """Another model, as said above. kiln's is where its formula says."""),
    (("clearcoat", "dielectric"), ("cycles",), "", 0.9, 1.1, """What is left beside the exact Fresnel term, which is
in the
computed ratio: Cycles compensates and scales by tables of its own."""),
    (("iridescence",), ("cycles",), "", 0.3, 3.0, """glTF's film takes colours from a fit of the CIE curves and
Schlick's F0 for
what is below, Cycles from three bands and a complex index that it makes of the colour. Same order of colours, not
the same
values."""),
]
