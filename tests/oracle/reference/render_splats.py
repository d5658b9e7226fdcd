# SPDX-License-Identifier: Apache-2.0
"""A small reference renderer of four kinds of splats: plain Python 3, double precision, no tiles.

Written from the papers, for checking faster renderers; it does nothing to be quick.
  windows    Triangle Splatting (arXiv 2505.19175): soft triangles
  gaussians  3D Gaussian Splatting (Kerbl et al. 2023): EWA-projected 3D Gaussians
  discs      2D Gaussian Splatting (Huang et al. 2024): ray-intersected flat Gaussians
  neural     Splat the Net (arXiv 2510.08491): ellipsoids with a small network as density

Frames. The camera file has OpenGL axes (x right, y up, looking along -z). Internally every
kernel uses the axes of the papers: x right, y down, z forward. The image spans 0..width by
0..height, row 0 is at the top, and pixel (i, j) has its centre at (i + 0.5, j + 0.5):
    X = cx + fx x/z,   Y = cy + fy y/z.
(3DGS and Triangle Splatting put pixel centres at whole numbers and shift the projection by
-1/2, ndc2Pix = ((v+1)S-1)/2: the same picture.)

Run as `render_splats.py FILE.json ...` to check itself and compare files with a new rendering.
"""
import json
import math
import struct
import sys

MIN_ALPHA = 1.0 / 255.0   # 3DGS appendix C and its code: weaker contributions are skipped
MIN_TRANSMITTANCE = 1e-4  # same place: a splat that would bring T below this ends the pixel


def f32(v):
    """Rounds numbers (nested lists as well) to the nearest float32."""
    if isinstance(v, (list, tuple)):
        return [f32(x) for x in v]
    return struct.unpack("<f", struct.pack("<f", v))[0]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    n = math.sqrt(dot(a, a))
    return [x / n for x in a]


def rotation_columns(q):
    """Columns of the rotation of quaternion (w, x, y, z), normalised here (3DGS eq. 6's R)."""
    w, x, y, z = unit(q)
    return [[1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
            [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
            [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]]


class Camera:
    def __init__(self, c):
        self.width, self.height = int(c["width"]), int(c["height"])
        self.fx, self.fy, self.cx, self.cy = (float(c[k]) for k in ("fx", "fy", "cx", "cy"))
        m = c["world_from_camera"]
        self.eye = [m[r][3] for r in range(3)]
        # Rows of the world-to-camera rotation, with y and z turned from OpenGL to x right,
        # y down, z forward. The matrix is taken as a rotation: inverse = transpose.
        self.rows = [[m[r][0] for r in range(3)], [-m[r][1] for r in range(3)],
                     [-m[r][2] for r in range(3)]]

    def turn(self, v):
        """World direction -> camera direction."""
        return [dot(r, v) for r in self.rows]

    def view(self, p):
        """World point -> camera point."""
        return self.turn(sub(p, self.eye))

    def project(self, p):
        return [self.cx + self.fx * p[0] / p[2], self.cy + self.fy * p[1] / p[2]]

    def ray(self, x, y):
        """Camera-space direction (depth 1) through image point (x, y)."""
        return [(x - self.cx) / self.fx, (y - self.cy) / self.fy, 1.0]


# Real spherical harmonics, order and signs as in 3DGS' computeColorFromSH / PlenOctrees.
def sh_basis(degree, d):
    x, y, z = d
    b = [0.28209479177387814]
    if degree > 0:
        c = 0.4886025119029199
        b += [-c * y, c * z, -c * x]
    if degree > 1:
        b += [1.0925484305920792 * x * y, -1.0925484305920792 * y * z,
              0.31539156525252005 * (2 * z * z - x * x - y * y),
              -1.0925484305920792 * x * z, 0.5462742152960396 * (x * x - y * y)]
    if degree > 2:
        b += [-0.5900435899266435 * y * (3 * x * x - y * y), 2.890611442640554 * x * y * z,
              -0.4570457994644658 * y * (4 * z * z - x * x - y * y),
              0.3731763325901154 * z * (2 * z * z - 3 * x * x - 3 * y * y),
              -0.4570457994644658 * x * (4 * z * z - x * x - y * y),
              1.445305721320277 * z * (x * x - y * y),
              -0.5900435899266435 * x * (x * x - 3 * y * y)]
    return b


def sh_colour(sh, degree, centre, eye):
    """max(0, 1/2 + sum Y_k c_k) in direction centre - eye, in world axes (3DGS code)."""
    b = sh_basis(degree, unit(sub(centre, eye)))
    return [max(0.0, 0.5 + sum(b[k] * sh[k][c] for k in range(len(b)))) for c in range(3)]


# Each kernel below is a function (camera, splats, n, profile) -> (view depth of the centre,
# centre, shade). shade(x, y) gives (alpha before the clamp to max_alpha, fragile); fragile says
# that rounding in single precision could decide otherwise whether the pixel is inside at all.

def window(cam, s, n, profile):
    """Triangle Splatting, section 3 (fact sheet 02 section 2)."""
    corners, sigma, opacity = s["corners"][n], s["sigma"][n], s["opacity"][n]
    centroid = [sum(c[k] for c in corners) / 3.0 for k in range(3)]
    v = [cam.view(c) for c in corners]
    middle = cam.view(centroid)
    normal = unit(cross(sub(v[1], v[0]), sub(v[2], v[0])))
    # The code's own tests (not in the paper): weak, behind, exactly edge-on. Its tests of size
    # in pixels and its tile bounds are left out on purpose.
    if opacity < 0.01 or middle[2] <= 0.2 or abs(dot(normal, unit(middle))) < 1e-3:
        return middle[2], centroid, lambda x, y: (0.0, False)
    q = [cam.project(p) for p in v]
    # Incentre = corners weighted by the lengths of the opposite sides.
    side = [math.dist(q[1], q[2]), math.dist(q[2], q[0]), math.dist(q[0], q[1])]
    incentre = [sum(side[k] * q[k][c] for k in range(3)) / sum(side) for c in range(2)]
    # L_k(p) = n_k . p + d_k, unit normals outward: negative at the incentre.
    lines = []
    for k in range(3):
        a, b = q[k], q[(k + 1) % 3]
        m = unit([b[1] - a[1], a[0] - b[0]])
        if dot(m, sub(incentre, a)) > 0:
            m = [-m[0], -m[1]]
        lines.append((m, a))

    def phi(p):  # signed distance inside: phi(p) = max_k L_k(p)
        return max(dot(m, sub(p, a)) for m, a in lines)

    phi_s = phi(incentre)  # = - radius of the inscribed circle

    def shade(x, y):
        f = phi([x, y])
        # Close to the edge the value may jump (small sigma): how much, 2/1000 px inside?
        jump = abs(f) < 2e-3 and opacity * min(1.0, 2e-3 / -phi_s) ** sigma > MIN_ALPHA
        if f > 0:
            return 0.0, jump
        return opacity * (f / phi_s) ** sigma, jump  # I(p) = ReLU(phi(p)/phi(s))^sigma
    return middle[2], centroid, shade


def gaussian(cam, s, n, profile):
    centre, opacity = s["centres"][n], s["opacity"][n]
    x, y, z = cam.view(centre)
    # 3DGS eq. 6: Sigma = R S S^T R^T. The columns of R S, seen in camera axes, are W R S.
    axes = [[a * c for c in cam.turn(col)]
            for a, col in zip(s["scales"][n], rotation_columns(s["rotations"][n]))]
    # EWA splatting (Zwicker 2002) eq. 29: Jacobian at the centre. 3DGS' code clamps x/z and y/z
    # there to +-1.3 tan(fov/2) (tan = width/(2 fx)); nothing in the scenes reaches the clamp.
    lx, ly = 1.3 * 0.5 * cam.width / cam.fx, 1.3 * 0.5 * cam.height / cam.fy
    tx, ty = min(lx, max(-lx, x / z)), min(ly, max(-ly, y / z))
    jx = [cam.fx / z, 0.0, -cam.fx * tx / z]
    jy = [0.0, cam.fy / z, -cam.fy * ty / z]
    # 3DGS eq. 5: Sigma' = J W Sigma W^T J^T; its code adds 0.3 px^2 on the diagonal
    # (no opacity compensation: antialiasing off).
    px, py = [dot(jx, a) for a in axes], [dot(jy, a) for a in axes]
    a, b, c = dot(px, px) + 0.3, dot(px, py), dot(py, py) + 0.3
    det = a * c - b * b
    mx, my = cam.project([x, y, z])

    def shade(u, v):
        dx, dy = u - mx, v - my
        # 3DGS eq. 4 in 2D: exp(-1/2 d^T Sigma'^-1 d), times opacity
        return opacity * math.exp(-0.5 * (c * dx * dx - 2 * b * dx * dy + a * dy * dy) / det), False
    return z, centre, shade


def disc(cam, s, n, profile):
    centre, opacity = s["centres"][n], s["opacity"][n]
    m = cam.view(centre)
    tu, tv, tw = [cam.turn(c) for c in rotation_columns(s["rotations"][n])]  # 2DGS section 4.1
    su, sv = s["scales"][n]
    if profile["filter_centre"] == "projected_centre":
        # 2DGS eq. 11: "c is the projection of center p_k"
        fc = cam.project(m)
    else:
        # 2DGS code (compute_aabb, cutoff 3): centre of the bounding box of the 3 sigma ellipse.
        # Rows of the map (u, v, 1) -> (w X, w Y, w), eq. 7.
        rows = list(zip([su * k for k in tu], [sv * k for k in tv], m))
        rows = [[cam.fx * a + cam.cx * b for a, b in zip(rows[0], rows[2])],
                [cam.fy * a + cam.cy * b for a, b in zip(rows[1], rows[2])], rows[2]]
        t = [9.0, 9.0, -1.0]
        d = sum(t[k] * rows[2][k] ** 2 for k in range(3))
        fc = [sum(t[k] * rows[r][k] * rows[2][k] for k in range(3)) / d for r in range(2)]

    def shade(x, y):
        # Ray and plane of the disc: the same point as 2DGS eq. 8-10, found directly.
        r = cam.ray(x, y)
        down = dot(tw, r)
        if down == 0.0:
            return 0.0, True  # the code skips rays in the plane
        depth = dot(tw, m) / down
        h = sub([depth * k for k in r], m)
        u, v = dot(h, tu) / su, dot(h, tv) / sv  # eq. 4: P(u,v) = p + su tu u + sv tv v
        rho3d, rho2d = u * u + v * v, 2.0 * ((x - fc[0]) ** 2 + (y - fc[1]) ** 2)
        # eq. 6 and 11: max(G(u), G((x - c)/sigma)), sigma = sqrt(2)/2
        alpha = opacity * math.exp(-0.5 * min(rho3d, rho2d))
        if (depth if rho3d <= rho2d else m[2]) < 0.2:
            # Near plane of the code. Fragile where it matters: nowhere in the scenes.
            return 0.0, alpha > 0.9 * MIN_ALPHA
        return alpha, False
    return m[2], centre, shade


# Gauss-Legendre, 4 points on [-1, 1]
GL = [(sign * math.sqrt(3 / 7 - k * 2 / 7 * math.sqrt(6 / 5)), (18 + k * math.sqrt(30)) / 36)
      for k in (1, -1) for sign in (1, -1)]
largest_difference = [0.0]  # between the two integrals below, over all rays so far


def neural(cam, s, n, profile):
    """Density f(u) = b2 + sum_k a_k cos(omega (w_k . u + b1_k)), u = (x - centre)/(largest
    semi-axis), in world axes: not turned with the ellipsoid (paper section 3, code, sheet 03)."""
    centre, w, b1, a, b2 = (s[k][n] for k in ("centres", "w", "b1", "a", "b2"))
    semi, omega = s["scales"][n], profile["omega"]
    columns, largest = rotation_columns(s["rotations"][n]), max(semi)
    oc = sub(cam.eye, centre)
    og = [dot(c, oc) / k for c, k in zip(columns, semi)]  # S^-1 R^T (eye - centre)

    def density(u):
        return b2 + sum(a[k] * math.cos(omega * (dot(w[k], u) + b1[k])) for k in range(8))

    def shade(x, y):
        r = cam.ray(x, y)
        d = unit([sum(cam.rows[i][k] * r[i] for i in range(3)) for k in range(3)])  # to world
        # Chord: |S^-1 R^T (eye + t d - centre)| = 1, taken from its middle t_m
        dg = [dot(c, d) / k for c, k in zip(columns, semi)]
        A = dot(dg, dg)
        t_m = -dot(og, dg) / A
        foot = [p + t_m * q for p, q in zip(og, dg)]
        disc_ = 1.0 - dot(foot, foot)
        if disc_ <= 0.0:
            return 0.0, False
        h = math.sqrt(disc_ / A)
        assert t_m - h > 0.2, "the reference code would integrate behind the eye"
        # Optical depth = integral of f over length in u: dt / largest.
        mid = [(p + t_m * q) / largest for p, q in zip(oc, d)]
        step, half = [k / largest for k in d], h / 64.0
        quad = 0.0
        for panel in range(64):
            t = -h + (2 * panel + 1) * half
            quad += sum(wt * density([m + (t + half * g) * e for m, e in zip(mid, step)])
                        for g, wt in GL)
        quad *= half / largest
        # Closed form (paper eq. 5-6): cos(p + b t) integrates to (sin(p + b h) - sin(p - b h))/b
        exact = b2 * 2 * h
        for k in range(8):
            b, p = omega * dot(w[k], step), omega * (dot(w[k], mid) + b1[k])
            exact += a[k] * (2 * h * math.cos(p) if abs(b) * h < 1e-7 else
                             (math.sin(p + b * h) - math.sin(p - b * h)) / b)
        largest_difference[0] = max(largest_difference[0], abs(quad - exact / largest))
        # Negative integrals count as nothing; alpha = 1 - exp(-depth), clamped later as the
        # code does: min(0.99f, 1 - exp(-integral)).
        return -math.expm1(-max(quad, 0.0)), False
    return cam.view(centre)[2], centre, shade


KERNELS = {"windows": window, "gaussians": gaussian, "discs": disc, "neural": neural}


def render(scene):
    """Returns {"image", "alpha"} and counts of what happened, for the scene's profile."""
    profile, s, cam = scene["profile"], scene["splats"], Camera(scene["camera"])
    kernel, degree = KERNELS[profile["kernel"]], profile["sh_degree"]
    items = []
    for n in range(len(s["sh"])):
        depth, centre, shade = kernel(cam, s, n, profile)
        items.append((depth, n, sh_colour(s["sh"][n], degree, centre, cam.eye), shade))
    items.sort(key=lambda t: t[:2])  # front to back by view depth of the centre
    out = {"image": [], "alpha": [], "fragile": [], "clamped": 0, "stopped": 0, "blended": 0,
           "depths": [t[0] for t in items]}
    for j in range(cam.height):
        for i in range(cam.width):
            colour, T, fragile = [0.0, 0.0, 0.0], 1.0, False
            for _, _, c, shade in items:
                raw, edge = shade(i + 0.5, j + 0.5)
                # a decision that single precision may take otherwise
                fragile |= edge or abs(raw / MIN_ALPHA - 1) < 3e-4
                alpha = min(profile["max_alpha"], raw)
                if alpha < MIN_ALPHA:
                    continue
                after = T * (1.0 - alpha)
                fragile |= abs(after / MIN_TRANSMITTANCE - 1) < 1e-3
                if after < MIN_TRANSMITTANCE:
                    out["stopped"] += 1
                    break  # this splat is not blended
                out["clamped"] += raw > profile["max_alpha"]
                out["blended"] += 1
                # 3DGS eq. 3: C = sum c_i alpha_i prod_{j<i} (1 - alpha_j)
                colour = [p + q * alpha * T for p, q in zip(colour, c)]
                T = after
            out["image"] += colour  # black background, not clamped above
            out["alpha"].append(1.0 - T)
            if fragile:
                out["fragile"].append(j * cam.width + i)
    return out


def self_check():
    """Pixel values found by hand."""
    def near(a, b, eps=1e-9):
        assert abs(a - b) < eps, (a, b)

    cam = Camera({"width": 48, "height": 36, "fx": 40, "fy": 40, "cx": 24.5, "cy": 18.5,
                  "world_from_camera": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]})
    # Frame: a point up and to the right, 2 in front, lands up (smaller Y) and to the right.
    assert cam.project(cam.view([0.1, 0.2, -2])) == [26.5, 14.5]
    # Addition theorem: for each degree l, sum_m Y_lm^2 = (2l+1)/(4 pi) in every direction.
    b = sh_basis(3, unit([0.3, -0.7, 0.5]))
    for l in range(4):
        near(sum(v * v for v in b[l * l:(l + 1) ** 2]), (2 * l + 1) / (4 * math.pi))
    # Looking along -z only m = 0 is left: C0, -C1, 2 C2, -2 C3.
    b = sh_basis(3, [0, 0, -1])
    near(b[2], -0.4886025119029199), near(b[6], 0.6307831305050401)
    near(b[12], -0.7463526651802308)
    # Window: legs 9 and 12 px, so hypotenuse 15, inscribed radius 3 and incentre (3, 3) from the
    # right angle at image point (20.5, 20.5) (x right, y down). f/z = 20 px per unit at z = 2.
    # Sixteenths would not be whole, so corners are given in pixels over 20.
    right = {"corners": [[[-4 / 20, -2 / 20, -2], [5 / 20, -2 / 20, -2], [-4 / 20, -14 / 20, -2]]],
             "sigma": [2.0], "opacity": [0.8]}
    shade = window(cam, right, 0, {})[2]
    near(shade(23.5, 23.5)[0], 0.8)            # I = 1 at the incentre
    near(shade(22.0, 23.5)[0], 0.8 * 0.25)     # half-way to the edge: (1.5/3)^2
    near(shade(20.4, 23.5)[0], 0.0)            # outside
    # Gaussian: sd 0.1 at depth 2 is 2 px, variance 4 + 0.3; one pixel off: 0.8 exp(-1/8.6).
    ball = {"centres": [[0, 0, -2]], "rotations": [[1, 0, 0, 0]], "scales": [[0.1, 0.1, 0.1]],
            "opacity": [0.8]}
    shade = gaussian(cam, ball, 0, {})[2]
    near(shade(24.5, 18.5)[0], 0.8), near(shade(25.5, 18.5)[0], 0.8 * math.exp(-1 / 8.6))
    near(shade(25.5, 18.5)[0], 0.7121814, 1e-7)  # 1 - .11627907 + .00676041 - .00026203 + .00000762
    # The same at x = 1: J's first row (20, 0, -10), variance 0.01 (400 + 100) + 0.3 in x, 4.3 in y.
    ball["centres"] = [[1, 0, -2]]
    shade = gaussian(cam, ball, 0, {})[2]
    near(shade(46.5, 18.5)[0], 0.8 * math.exp(-0.5 * 4 / 5.3))
    near(shade(44.5, 20.5)[0], 0.8 * math.exp(-0.5 * 4 / 4.3))
    # Disc facing the eye: one pixel is 0.05 = u 0.5, so exp(-1/8) beats the filter's exp(-1).
    # A disc ten times smaller: the filter wins, exp(-1) one pixel off.
    flat = {"centres": [[0, 0, -2]], "rotations": [[1, 0, 0, 0]], "scales": [[0.1, 0.1]],
            "opacity": [0.8]}
    for centre in ("projected_centre", "bounding_box_centre"):
        flat["scales"] = [[0.1, 0.1]]
        near(disc(cam, flat, 0, {"filter_centre": centre})[2](25.5, 18.5)[0], 0.8 * math.exp(-1 / 8))
        flat["scales"] = [[0.01, 0.01]]
        near(disc(cam, flat, 0, {"filter_centre": centre})[2](25.5, 18.5)[0], 0.8 * math.exp(-1))
    # The first disc turned by 60 degrees about y (tu = (1/2, 0, -sqrt 3/2) in OpenGL axes): the
    # ray 2 px to the right, x = 0.05 z, meets x = h/2, z = 2 + h sqrt(3)/2 at
    # h = 0.1/(0.5 - 0.05 sqrt(3)/2), so u = 10 h.
    flat.update(rotations=[[math.cos(math.pi / 6), 0, math.sin(math.pi / 6), 0]], scales=[[0.1, 0.1]])
    u = 1 / (0.5 - 0.025 * math.sqrt(3))
    near(disc(cam, flat, 0, {"filter_centre": "projected_centre"})[2](26.5, 18.5)[0],
         0.8 * math.exp(-0.5 * u * u))
    # Neural: constant density 1/4 in a ball; a ray through the centre has length 2 in u, whatever
    # the radius: alpha = 1 - exp(-1/2) = 0.39346934.
    zero = [[0.0, 0.0, 0.0]] * 8
    net = {"centres": [[0, 0, -2]], "rotations": [[1, 0, 0, 0]], "scales": [[0.3, 0.3, 0.3]],
           "w": [zero], "b1": [[0.0] * 8], "a": [[0.0] * 8], "b2": [0.25]}
    near(neural(cam, net, 0, {"omega": 30.0})[2](24.5, 18.5)[0], 0.3934693402873666)
    # One neuron along the ray: a integral_{-1}^{1} cos(30 w u) du = 2 a sin(30 w)/(30 w), plus 1/2.
    net.update(w=[[[0, 0, 0.1]] + zero[1:]], a=[[1.0] + [0.0] * 7])
    near(neural(cam, net, 0, {"omega": 30.0})[2](24.5, 18.5)[0],
         1 - math.exp(-(0.5 + 2 * math.sin(3.0) / 3.0)))
    # Sheet 02's two triangles: o = 0.5 in front, o = 1 behind, same incentre pixel, colours
    # 1/2 (all sh 0): 0.5 (0.5 + 0.495) and alpha 1 - 0.005.
    two = {"corners": right["corners"] + [[[1.5 * k for k in c] for c in right["corners"][0]]],
           "sigma": [1.0, 1.0], "opacity": [0.5, 1.0], "sh": [[[0, 0, 0]]] * 2}
    r = render({"camera": {"width": 48, "height": 36, "fx": 40, "fy": 40, "cx": 24.5, "cy": 18.5,
                           "world_from_camera": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]},
                "profile": {"kernel": "windows", "sh_degree": 0, "max_alpha": 0.99}, "splats": two})
    near(r["image"][3 * (23 * 48 + 23)], 0.5 * 0.995), near(r["alpha"][23 * 48 + 23], 0.995)


def load(path):
    with open(path, encoding="ascii") as f:
        scene = json.load(f)
    scene["splats"] = {k: f32(v) for k, v in scene["splats"].items()}  # 9 digits name one float32
    scene["camera"]["world_from_camera"] = f32(scene["camera"]["world_from_camera"])
    return scene


if __name__ == "__main__":
    self_check()
    print("self check passed")
    for path in sys.argv[1:]:
        scene = load(path)
        out = render(scene)
        for key in ("image", "alpha"):
            print(path, key, "largest difference from the file: %.2e"
                  % max(abs(a - b) for a, b in zip(out[key], scene[key])))
