# SPDX-License-Identifier: Apache-2.0
"""Writes windows.json, gaussians.json, discs.json and neural.json:
24 splats each from fixed seeds, and their pictures by render_splats.py.

The generator is a 64-bit integer one of our own, and only + - * / and sqrt touch its numbers,
so every Python writes the same splats. A seed is passed over when single precision could decide
differently anywhere in the picture (alpha < 1/255, T < 1e-4, in or out of a window)."""
import copy
import math
import os
import time

import render_splats as R

HERE = os.path.dirname(os.path.abspath(__file__))
N = 24
# Off-centre and with unequal focal lengths on purpose. Change these for a camera that can't.
CAMERA = {"width": 48, "height": 36, "fx": 44.0, "fy": 42.0, "cx": 23.5, "cy": 18.25}
EYE, TURN = [0.75, -0.5, 3.25], [0.9, 0.2, -0.35, 0.1]  # camera position, quaternion w x y z


class Random:
    """xorshift64* (Vigna 2016) with integers only."""

    def __init__(self, seed):
        self.s = (seed * 0x9E3779B97F4A7C15 + 1) & (2 ** 64 - 1)

    def between(self, lo, hi):
        s = self.s
        s ^= s >> 12
        s ^= (s << 25) & (2 ** 64 - 1)
        s ^= s >> 27
        self.s = s
        return lo + (hi - lo) * (((s * 0x2545F4914F6CDD1D) & (2 ** 64 - 1)) >> 12) / 2.0 ** 52

    def step(self, lo, hi, per_unit):
        """A multiple of 1/per_unit: short in the file and exact in float32."""
        return math.floor(self.between(lo, hi) * per_unit + 0.5) / per_unit

    def direction(self):
        while True:
            v = [self.between(-1, 1) for _ in range(3)]
            if 0.01 < R.dot(v, v) < 1:
                return R.unit(v)

    def quaternion(self):
        while True:
            v = [self.between(-1, 1) for _ in range(4)]
            if 0.01 < R.dot(v, v) < 1:
                return R.unit(v)


def quaternion_of(c):
    """Quaternion of a rotation with columns c (positive trace or not)."""
    m = lambda r, k: c[k][r]
    best = max(range(4), key=lambda k: [m(0, 0) + m(1, 1) + m(2, 2), m(0, 0), m(1, 1), m(2, 2)][k])
    if best == 0:
        w = 1 + m(0, 0) + m(1, 1) + m(2, 2)
        return R.unit([w, m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)])
    i, j, k = [(0, 1, 2), (1, 2, 0), (2, 0, 1)][best - 1]
    q = [0.0] * 4
    q[0], q[1 + i] = m(k, j) - m(j, k), 1 + m(i, i) - m(j, j) - m(k, k)
    q[1 + j], q[1 + k] = m(j, i) + m(i, j), m(k, i) + m(i, k)
    return R.unit(q)


def world_from_camera():
    c = R.rotation_columns(TURN)
    return R.f32([[c[k][r] for k in range(3)] + [EYE[r]] for r in range(3)] + [[0.0, 0.0, 0.0, 1.0]])


def place(cam, x, y, depth):
    """World point that projects to image point (x, y) at that view depth."""
    r = cam.ray(x, y)
    return [cam.eye[k] + depth * sum(cam.rows[i][k] * r[i] for i in range(3)) for k in range(3)]


def layout(g):
    """24 places: (x, y, depth, kind). kind: strong, edge, tiny or plain."""
    p = [(math.floor(g.between(6, 30)) + 0.5, math.floor(g.between(6, 28)) + 0.5, 1.5, "plain")]
    p += [(g.between(6, 30), g.between(6, 27), g.between(1.2, 5), "plain") for _ in range(8)]
    p += [(g.between(17, 19), g.between(15, 17), g.between(1.5, 4), "strong") for _ in range(6)]
    p += [(g.between(10, 26), g.between(9, 24), g.between(1.5, 3), "edge") for _ in range(3)]
    p += [(0.6, g.between(9, 14), 2.5, "plain"), (g.between(30, 40), 0.4, 1.7, "plain"),
          (47.4, g.between(24, 31), 3.1, "plain"), (g.between(10, 30), 36.6, 2.2, "plain"),
          (-1.4, g.between(22, 28), 0.9, "plain"), (g.between(33, 38), g.between(10, 14), 6.0, "tiny")]
    return p


def make(kernel, seed):
    g = Random(seed)
    cam = R.Camera(dict(CAMERA, world_from_camera=world_from_camera()))
    degree = {"windows": 3, "gaussians": 2, "discs": 0, "neural": 1}[kernel]
    s = {k: [] for k in {"windows": ["corners", "sigma", "opacity"],
                         "gaussians": ["centres", "rotations", "scales", "opacity"],
                         "discs": ["centres", "rotations", "scales", "opacity"],
                         "neural": ["centres", "rotations", "scales", "w", "b1", "a", "b2"]}[kernel]}
    s["sh"] = []
    for n, (x, y, depth, kind) in enumerate(layout(g)):
        centre = place(cam, x, y, depth)
        pixel = depth / cam.fx  # world size of a pixel there
        size = {"windows": g.between(7, 13), "gaussians": g.between(1.0, 2.0),
                "discs": g.between(1.5, 3.2), "neural": g.between(3, 6.5)}[kernel]
        if kind == "strong" or n == 0:
            size *= 1.3
        if kind == "tiny":
            size *= 0.15 if kernel in ("gaussians", "discs") else 0.4
        if kind == "edge":
            size *= 1.6
            # Normal across the ray, leaning by a few degrees: third axis e cos - d sin.
            d = R.unit(R.sub(centre, cam.eye))
            e = R.unit(R.cross(d, g.direction()))
            t = g.between(0.02, 0.06)
            co, si = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
            normal = [co * a - si * b for a, b in zip(e, d)]
            along = [co * b + si * a for a, b in zip(e, d)]
            q = quaternion_of([along, R.cross(normal, along), normal])
        else:
            q = g.quaternion()
        size *= pixel
        opacity = {"strong": g.between(0.9, 0.975), "edge": g.between(0.7, 0.95)}.get(
            kind, g.between(0.15, 0.9))
        if n == 0:
            opacity = 1.0  # the clamp to max_alpha
        if kernel == "windows":
            cu, cv, _ = R.rotation_columns(q)
            while True:  # a triangle without needles, its centroid at the centre
                flat = [[g.between(-1, 1), g.between(-1, 1)] for _ in range(3)]
                a, b = R.sub(flat[1], flat[0]), R.sub(flat[2], flat[0])
                if abs(a[0] * b[1] - a[1] * b[0]) > 0.9:
                    break
            mean = [sum(f[k] for f in flat) / 3 for k in range(2)]
            s["corners"].append([[centre[k] + size * ((f[0] - mean[0]) * cu[k] + (f[1] - mean[1]) * cv[k])
                                  for k in range(3)] for f in flat])
            s["sigma"].append(0.0125 if n == 0 else 0.15 if kind == "strong" else
                              [0.05, 0.3, 1.0, 1.16, 2.5][n % 5] * g.between(0.8, 1.2))
            s["opacity"].append(opacity)
        else:
            s["centres"].append(centre)
            s["rotations"].append(q)
            third = 0.002 if kind == "edge" else g.between(0.3, 1.2)
            if kernel == "neural" and kind == "edge":
                third = 0.08
            s["scales"].append([size * g.between(0.5, 1.5), size * g.between(0.5, 1.5)] +
                               ([size * third] if kernel != "discs" else []))
            if kernel != "neural":
                s["opacity"].append(opacity)
            else:
                # omega w in +-12, phases over a full turn, waves up to 1.5
                s["w"].append([[g.step(-0.4, 0.4, 64) for _ in range(3)] for _ in range(8)])
                s["b1"].append([g.step(-0.33, 0.33, 128) for _ in range(8)])
                s["a"].append([g.step(-1.5, 1.5, 16) for _ in range(8)])
                s["b2"].append({"strong": g.between(4, 8), "edge": g.between(2, 5)}.get(
                    kind, g.between(-0.4, 2.0)))
                if n == 1:
                    s["w"][n][0] = [0.0, 0.0, 0.0]         # a constant neuron: b = 0 exactly
                    s["w"][n][1] = [2.0 ** -14, 0.0, 0.0]  # and one nearly so
                if n == 2:
                    s["a"][n] = [0.0] * 8                  # constant density
        s["sh"].append([[g.step(-1.2, 1.8, 64) for _ in range(3)]] +
                       [[g.step(-0.4, 0.4, 32) for _ in range(3)] for _ in range((degree + 1) ** 2 - 1)])
    s = {k: R.f32(v) for k, v in s.items()}
    profile = {"kernel": kernel, "seed": seed, "sh_degree": degree, "max_alpha": 0.99,
               "min_alpha": "1/255: weaker contributions are skipped",
               "min_transmittance": "1e-4: a splat that would bring T below ends the pixel unblended",
               "order": "view depth of the centre, front to back, one order for the whole picture",
               "pixel_centre": "(i + 0.5, j + 0.5); X = cx + fx x/z, Y = cy + fy y/z (y down)",
               "colour": "max(0, 1/2 + sum_k Y_k sh[n][k][rgb]), direction centre - eye in world axes, 3DGS order and signs",
               "result": "accumulated colour over black, not clamped; alpha = 1 - T"}
    quaternion = "w, x, y, z; normalise; columns of the matrix are the axes"
    if kernel == "windows":
        profile.update(corners="world [3][3]", sigma="exponent, after activation",
                       centre="mean of the corners", culls="none by size in pixels, no tile bounds")
    if kernel == "gaussians":
        profile.update(rotations=quaternion, scales="standard deviations", low_pass="+0.3 px^2 on the diagonal",
                       bounds="none: no 3 sigma radius, no tiles", opacity_compensation="none")
    if kernel == "discs":
        profile.update(rotations=quaternion + ": tu, tv, normal", scales="su, sv: standard deviations",
                       exponent="-1/2 min(u^2 + v^2, 2 |d|^2)", filter_centre="projected_centre",
                       bounds="none", near="hits nearer than 0.2 skipped (none here)")
    if kernel == "neural":
        profile.update(rotations=quaternion, scales="semi-axes of the ellipsoid (density is 0 outside)",
                       omega=30.0, density="b2 + sum_k a[k] cos(omega (w[k] . u + b1[k]))",
                       u="(point - centre)/(largest semi-axis), world axes, not rotated",
                       alpha="1 - exp(-max(0, integral of density over length in u along the chord)), then min with max_alpha",
                       integral="64 panels of 4-point Gauss-Legendre on the chord")
    return {"camera": dict(CAMERA, world_from_camera=world_from_camera()), "profile": profile, "splats": s}


def check(scene, out, kernel):
    """What the scenes promise; returns why not, or None."""
    cam, s = R.Camera(scene["camera"]), scene["splats"]
    centres = s["centres"] if "centres" in s else [[sum(c[k] for c in t) / 3 for k in range(3)] for t in s["corners"]]
    view = [cam.view(c) for c in centres]
    assert min(v[2] for v in view) > 0.5
    # inside 3DGS' clamp, so that it doesn't matter how it is done for an off-centre camera
    assert all(abs(v[0] / v[2]) < 0.65 * 48 / cam.fx and abs(v[1] / v[2]) < 0.65 * 36 / cam.fy for v in view)
    if kernel == "windows":
        assert min(cam.view(c)[2] for t in s["corners"] for c in t) > 0.3
    d = out["depths"]
    if min(b - a for a, b in zip(d, d[1:])) < 1e-4:
        return "depths too close"
    if out["fragile"]:
        return "%d fragile pixels" % len(out["fragile"])
    if out["stopped"] < 3 or out["clamped"] < 1:
        return "%d early stops, %d clamps" % (out["stopped"], out["clamped"])
    return None


def text(v, form):
    if isinstance(v, dict):
        return "{" + ",\n".join('"%s": %s' % (k, text(x, form)) for k, x in v.items()) + "}"
    if isinstance(v, (list, tuple)):
        return "[" + ",".join(text(x, form) for x in v) + "]"
    if isinstance(v, str):
        return '"%s"' % v
    return (form % v) if v else "0"


def write(name, scene, out):
    body = "{" + ",\n".join(
        ['"%s": %s' % (k, text(scene[k], "%.9g")) for k in ("camera", "profile", "splats")] +
        ['"%s": %s' % (k, text(out[k], "%.8g")) for k in ("image", "alpha")]) + "}\n"
    with open(os.path.join(HERE, name + ".json"), "w", encoding="ascii", newline="\n") as f:
        f.write(body)
    return len(body)


def condition(scene, out):
    """Largest change of the picture when every splat number moves by up to one float32 step."""
    g, moved = Random(99), copy.deepcopy(scene)

    def shake(v):
        if isinstance(v, list):
            return [shake(x) for x in v]
        return v * (1 + g.between(-1, 1) * 2.0 ** -23)
    moved["splats"] = {k: shake(v) for k, v in scene["splats"].items()}
    other = R.render(moved)
    return max(abs(a - b) for a, b in zip(out["image"] + out["alpha"], other["image"] + other["alpha"]))


def main():
    R.self_check()
    for kernel in ("windows", "gaussians", "discs", "neural"):
        seed = 0
        while True:
            seed += 1
            assert seed < 300, "no good seed"
            start = time.time()
            scene = make(kernel, seed)
            out = R.render(scene)
            why = check(scene, out, kernel)
            if why is None:
                break
            print("  %s seed %d passed over: %s (%.0f s)" % (kernel, seed, why, time.time() - start))
        size = write(kernel, scene, out)
        covered = sum(a > 0 for a in out["alpha"]) / len(out["alpha"])
        print("%s: seed %d, %d bytes, %.0f %% covered, %d blended, %d stopped, %d clamped, max colour %.3f, "
              "one float32 step in the splats changes it by %.1e"
              % (kernel, seed, size, 100 * covered, out["blended"], out["stopped"], out["clamped"],
                 max(out["image"]), condition(scene, out)))
        assert size < 60000, "file too large"
    print("neural: largest difference of quadrature and closed form: %.2e" % R.largest_difference[0])


if __name__ == "__main__":
    main()
