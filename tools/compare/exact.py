"""Mean radiance over the picture of a sphere from the formulas, with no renderer: mean(exact, renderer, environment) is
RGB, or None where this file knows no formula. A convex opaque sphere reflects each direction once, so that the mean
is one
integral, taken over a lattice of POINTS points; a smooth glass sphere, or a shell, meets light at one angle only, so
that
its paths are a geometric series.

kiln's forms are those that docs/materials.md states. They are written here anew, from the papers and from glTF, and
with
albedos integrated on the spot, so that they share neither code nor tables with kiln."""
import functools

import numpy as np

import scene

POINTS = 1 << 16
MUS = (np.arange(64) + 0.5) / 64  # cosines that albedos are tabulated at


def lattice(count, dimensions):
    """Points of [0, 1)^d: the additive recurrence of the root of x^(d+1) = x + 1 (Roberts 2018)."""
    root = 1.0
    for _ in range(60):
        root = (1 + root) ** (1 / (dimensions + 1))
    steps = np.arange(1, count + 1)[:, None] * root ** -np.arange(1.0, dimensions + 1)
    return (0.5 + steps) % 1


def dot(a, b):
    return (a * b).sum(-1, keepdims=True)


def unit(v):
    return v / np.sqrt(dot(v, v))


def length(v, alphas):
    return np.sqrt((v[..., :1] * alphas[0]) ** 2 + (v[..., 1:2] * alphas[1]) ** 2 + v[..., 2:] ** 2)


def g1(v, alphas):
    return 2 * v[..., 2:] / (v[..., 2:] + length(v, alphas))


def visible_normals(wo, alphas, u):
    """GGX normals that wo sees (Dupuy and Benyoub 2023)."""
    stretch = np.array([*alphas, 1])
    s = unit(wo * stretch)
    phi, z = 2 * np.pi * u[..., :1], (1 - u[..., 1:2]) * (1 + s[..., 2:]) - s[..., 2:]
    r = np.sqrt(np.maximum(1 - z * z, 0))
    return unit((np.concatenate([r * np.cos(phi), r * np.sin(phi), z], -1) + s) * stretch)


def specular(wo, alphas, u, correlated):
    """Reflected directions, the cosine at their microfacet, and G2/G1 for F = 1 (0 below the horizon). G2 is height
    correlated, or the product of both sides' G1 as in Mitsuba."""
    h = visible_normals(wo, alphas, u)
    c = dot(wo, h)
    wi = 2 * c * h - wo
    z = np.maximum(wi[..., 2:], 1e-9)
    if correlated:
        weight = (wo[..., 2:] + length(wo, alphas)) * z / (z * length(wo, alphas) + wo[..., 2:] * length(wi, alphas))
    else:
        weight = 2 * z / (z + length(wi, alphas))
    return wi, c, np.where(wi[..., 2:] > 0, weight, 0)


def schlick(c):
    return (1 - np.clip(c, 0, 1)) ** 5


@functools.lru_cache(None)
def albedos(alpha):
    """E for F = 1 and for F = (1 - c)^5 at MUS."""
    u = lattice(1 << 14, 2)
    wo = np.stack([np.sqrt(1 - MUS**2), 0 * MUS, MUS], -1)[:, None]
    _, c, weight = specular(wo, (alpha, alpha), u[None], True)
    return weight.mean((1, 2)), (weight * schlick(c)).mean((1, 2))


def mean_of(table):
    return 2 * (table * MUS).mean() if np.ndim(table) == 1 else 2 * (table * MUS[:, None]).mean(0)


def at(table, mu):
    table = np.asarray(table)
    columns = table[:, None] if table.ndim == 1 else table
    return np.concatenate([np.interp(mu[..., 0], MUS, columns[:, k])[..., None] for k in range(columns.shape[1])], -1)


@functools.lru_cache(None)
def sheen_albedo(roughness):
    u = lattice(1 << 14, 2)
    z, phi = u[:, :1] ** 2, 2 * np.pi * u[:, 1:]  # crowded at the horizon: dz = 2 sqrt(z) du
    r = np.sqrt(1 - z * z)
    wi = np.concatenate([r * np.cos(phi), r * np.sin(phi), z], -1)
    values = []
    for mu in MUS:
        wo = np.array([[np.sqrt(1 - mu * mu), 0, mu]])
        values.append((sheen_value(wo, wi, roughness) * 4 * np.pi * np.sqrt(z)).mean())
    return np.array(values)


def sheen_lambda(c, alpha):
    t = (1 - alpha) ** 2
    a, b, p, d, e = [x + (y - x) * t for x, y in ((21.5473, 25.3245), (3.82987, 3.32435), (0.19823, 0.16801),
                                                  (-1.97760, -1.27393), (-4.32054, -4.85967))]
    curve = lambda x: a / (1 + b * x**p) + d * x + e
    return np.exp(np.where(c < 0.5, curve(c), 2 * curve(0.5) - curve(1 - c)))


def sheen_value(wo, wi, roughness):
    """f cos of KHR_materials_sheen, D V cos with F = 1, and kiln's bound under a roughness of 0.28."""
    alpha, h = roughness**2, unit(wo + wi)
    d = (2 + 1 / alpha) * np.maximum(1 - h[..., 2:] ** 2, 0) ** (0.5 / alpha) / (2 * np.pi)
    shadow = 1 + sheen_lambda(wo[..., 2:], alpha) + sheen_lambda(wi[..., 2:], alpha)
    return min(roughness / 0.28, 1) * d / (4 * wo[..., 2:] * shadow)


class Sphere:
    """Points of the picture with frames, wo in them, and the radiance that comes from local directions."""

    def __init__(self, environment):
        u = lattice(POINTS, 7)
        pixels = np.argwhere(scene.inside())
        row, column = pixels[(u[:, 0] * len(pixels)).astype(int)].T
        step = 2 * scene.HALF / scene.SIZE
        x, y = (column + u[:, 1]) * step - scene.HALF, scene.HALF - (row + u[:, 2]) * step
        self.normal = np.stack([x, y, np.sqrt(1 - x * x - y * y)], 1)
        self.tangent = unit(np.stack([self.normal[:, 2], 0 * x, -x], 1))
        self.bitangent = np.cross(self.normal, self.tangent)
        self.wo = np.stack([self.tangent[:, 2], self.bitangent[:, 2], self.normal[:, 2]], 1)
        self.u, self.picture = u[:, 3:], scene.environment(environment)
        r, phi = np.sqrt(self.u[:, 3]), 2 * np.pi * self.u[:, 2]  # independent of microfacets
        self.cosine = np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - self.u[:, 3])], 1)

    def light(self, wi):
        world = wi[:, :1] * self.tangent + wi[:, 1:2] * self.bitangent + wi[:, 2:] * self.normal
        return scene.look_up(self.picture, world)

    def glossy(self, fresnel, alphas, correlated=True):
        wi, c, weight = specular(self.wo, alphas, self.u, correlated)
        return fresnel(c) * weight * self.light(wi)

    def spread(self, table):
        """The reciprocal lobe t(wo) t(wi)/(π mean t) over the hemisphere; what it returns, t, is a table over MUS."""
        mu = self.wo[:, 2:]
        return at(table, mu) * at(table, self.cosine[:, 2:]) / np.maximum(mean_of(table),
            1e-9) * self.light(self.cosine)


def metal(sphere, base, alpha, renderer):
    """Mitsuba knows single scattering; Cycles makes the lobe as much brighter as it misses (Turquin 2019, "Practical
    Multiple Scattering Compensation for Microfacet Models"), kiln adds a wide lobe (Kulla and Conty 2017)."""
    f = lambda c: base + (1 - base) * schlick(c)
    single = sphere.glossy(f, (alpha, alpha), renderer != "mitsuba")
    if renderer == "mitsuba":
        return single
    full, average = albedos(alpha)[0], (20 * base + 1) / 21
    e = mean_of(full)
    again = average * e / (1 - average * (1 - e))
    if renderer == "cycles":
        return single * (1 + again * (1 / at(full, sphere.wo[:, 2:]) - 1))
    return single + average * again * sphere.spread(1 - full)


@functools.lru_cache(None)
def interface_albedo(alpha, ior):
    u = lattice(1 << 13, 2)
    wo = np.stack([np.sqrt(1 - MUS**2), 0 * MUS, MUS], -1)[:, None]
    _, c, weight = specular(wo, (alpha, alpha), u[None], True)
    return (weight * fresnel(c, ior)).mean((1, 2))


def cycles_coated(sphere, base, alpha, strength, ior):
    """Cycles' coat: the exact Fresnel term, and below it what the coat leaves of the view's direction alone."""
    full, coat = albedos(alpha)[0], interface_albedo(alpha, ior)
    e, average = mean_of(full), mean_of(fresnel(MUS, ior))
    scale = 1 + average * e / (1 - average * (1 - e)) * (1 / at(full, sphere.wo[:, 2:]) - 1)
    single = sphere.glossy(lambda c: fresnel(c, ior), (alpha, alpha)) * scale
    passes = 1 - strength * at(coat, sphere.wo[:, 2:]) * scale
    return strength * single + base * passes * sphere.light(sphere.cosine)


def mixed(sphere, base, alpha, metallic, f0):
    full, share = albedos(alpha)
    coat = f0 * full + (1 - f0) * share
    single = sphere.glossy(lambda c: f0 + (1 - f0) * schlick(c), (alpha, alpha))
    plain = single + base * sphere.spread(1 - coat)
    return plain if metallic == 0 else metallic * metal(sphere, base, alpha, "kiln") + (1 - metallic) * plain


def clearcoat(sphere, base, alpha, strength):
    full, share = albedos(alpha)
    single = sphere.glossy(lambda c: 0.04 + 0.96 * schlick(c), (alpha, alpha))
    return strength * single + base * sphere.spread(1 - strength * (0.04 * full + 0.96 * share))


def sheen(sphere, base, roughness, strength):
    z = sphere.u[:, 1:2] ** 2
    phi, r = 2 * np.pi * sphere.u[:, :1], np.sqrt(1 - z * z)
    wi = np.concatenate([r * np.cos(phi), r * np.sin(phi), z], -1)
    lobe = sheen_value(sphere.wo, wi, roughness) * 4 * np.pi * np.sqrt(z) * sphere.light(wi)
    return strength * lobe + base * sphere.spread(1 - strength * sheen_albedo(roughness))


def anisotropic(sphere, alphas, renderer):
    """For kiln exactly what white microfacets miss comes back, spread as by an isotropic surface of the root
    mean square of both alphas."""
    wi, _, weight = specular(sphere.wo, alphas, sphere.u, renderer != "mitsuba")
    single = weight * sphere.light(wi)
    if renderer == "mitsuba":
        return single
    lost = 1 - albedos(float(np.sqrt(np.mean(np.square(alphas)))))[0]
    lobe = at(lost, sphere.cosine[:, 2:]) / mean_of(lost)
    return single + (1 - weight) * lobe * sphere.light(sphere.cosine)


def fresnel(c, eta):
    t = np.sqrt(1 - (1 - c * c) / eta**2)
    s, p = (c - eta * t) / (c + eta * t), (eta * c - t) / (eta * c + t)
    return (s * s + p * p) / 2


def bounces(sphere, reflectance, eta, sigma):
    """Outer reflection, and light that leaves after k reflections inside: a path turns in its plane of incidence by
    2 (θ - θt) + k (π - 2 θt) (van de Hulst 1957, 12.2)."""
    c = sphere.wo[:, 2:]
    theta, inner = np.arccos(c), np.arcsin(np.sqrt(1 - c * c) / eta)
    side = unit(sphere.normal * [1, 1, 0] + [1e-12, 0, 0])
    ahead = np.array([0, 0, -1.0])
    out = scene.look_up(sphere.picture, 2 * c * sphere.normal - [0, 0, 1]) * reflectance
    weight = (1 - reflectance) ** 2 * np.exp(-2 * np.cos(inner) * sigma)
    for k in range(64):  # more than 99.99 % of the light has left
        turn = 2 * (theta - inner) + k * (np.pi - 2 * inner)
        out = out + weight * scene.look_up(sphere.picture, np.cos(turn) * ahead - np.sin(turn) * side)
        weight = weight * reflectance * np.exp(-2 * np.cos(inner) * sigma)
    return out


@functools.lru_cache(None)
def sphere_in(environment):
    return Sphere(environment)


def mean(exact, renderer, environment):
    sphere, model = sphere_in(environment), exact["model"]
    base = np.array(exact.get("base", (1, 1, 1)))
    ours = renderer == "kiln"
    if model == "metal":
        value = metal(sphere, base, exact["alpha"], renderer)
    elif model == "mixed" and ours:
        value = mixed(sphere, base, exact["alpha"], exact["metallic"], exact["f0"])
    elif model == "mixed":
        share = exact["metallic"]
        value = (share * metal(sphere, base, exact["alpha"], renderer)
                 + (1 - share) * cycles_coated(sphere, base, exact["alpha"], 1.0, exact["ior"]))
    elif model == "clearcoat" and ours:
        value = clearcoat(sphere, base, exact["alpha"], exact["strength"])
    elif model == "clearcoat":
        value = cycles_coated(sphere, base, exact["alpha"], exact["strength"], 1.5)
    elif model == "sheen" and ours:
        value = sheen(sphere, base, exact["roughness"], exact["strength"])
    elif model == "anisotropic" and renderer != "cycles":
        value = anisotropic(sphere, exact["alphas"], renderer)
    elif model == "solid":
        f = fresnel(sphere.wo[:, 2:], exact["ior"])
        value = bounces(sphere, f, exact["ior"], np.array(exact.get("sigma", (0, 0, 0))))
    elif model == "shell" and renderer != "cycles":
        f = fresnel(sphere.wo[:, 2:], exact["ior"])
        value = bounces(sphere, f if ours else 2 * f / (1 + f), 1.0, np.zeros(3))
    else:
        return None
    return value.mean(0)
