#!/usr/bin/env python3
"""An engine for all five chapters of another style than whole_engine.py: constraints are rows of a Jacobian, bodies are
numbers in lists (q: x, y, angle; u: vx, vy, w), and errors of joints are fed back into velocities.

    plumb check -- python3 tests/course/rows.py

common_mistakes.py plants mistakes in it.
"""
import json, math, sys, time

HELLO = {"protocol": 1, "name": "rows", "version": "1", "precision": "double",
         "method": {"scheme": "semi_implicit_euler", "order": 1, "epsilon": 2.220446049250313e-16, "substeps": 1},
         "shapes": ["circle", "box"], "joints": ["distance", "revolute"],
         "forces": ["point_force", "linear_drag", "spring", "torque"], "features": ["contacts", "fixed_rotation"]}
MIX = {"maximum": max, "minimum": min, "product": lambda a, b: a * b, "average": lambda a, b: (a + b) / 2,
       "geometric_mean": lambda a, b: math.sqrt(a * b)}


def load(scene, dt):
    S = {"h": dt, "n": 0, "g": scene["gravity"], "rules": scene["contact_rules"], "laws": scene["forces"]}
    q, u, m, shape, idx = [], [], [], [], {}
    for k, b in enumerate(scene["bodies"]):
        idx[b["name"]] = k
        s = b["shapes"][0]
        live = b["type"] == "dynamic"
        q.append([*b["position"], b["angle"]])
        u.append([*b["velocity"], b["angular_velocity"]] if live else [0, 0, 0])
        k2 = s["radius"] ** 2 / 2 if s["type"] == "circle" else (s["width"] ** 2 + s["height"] ** 2) / 12
        im = 1 / b["mass"] if live else 0
        m.append([im, im, 0 if b["fixed_rotation"] else im / k2])
        shape.append(s)
    idx["world"] = len(q)
    for numbers in (q, u, m):
        numbers.append([0, 0, 0])
    shape.append(None)
    S.update(q=q, u=u, m=m, shape=shape, idx=idx)
    S["joints"] = [(idx[j["body_a"]], idx[j["body_b"]], j["anchor_a"], j["anchor_b"], j.get("length"), j["type"])
                   for j in scene["joints"]]
    S["skip"] = {frozenset((idx[j["body_a"]], idx[j["body_b"]])) for j in scene["joints"] if not j["collide"]}
    return S


def turn(p, a):
    return p[0] * math.cos(a) - p[1] * math.sin(a), p[0] * math.sin(a) + p[1] * math.cos(a)


def forces(S):
    q, u, m, h, idx = S["q"], S["u"], S["m"], S["h"], S["idx"]
    F = [[0, 0, 0] for _ in q]
    t = S["n"] * h + 1e-9

    def at(k, p):
        rx, ry = turn(p, q[k][2])
        return q[k][0] + rx, q[k][1] + ry, u[k][0] - u[k][2] * ry, u[k][1] + u[k][2] * rx, rx, ry

    def add(k, fx, fy, rx, ry):
        F[k][0] += fx
        F[k][1] += fy
        F[k][2] += rx * fy - ry * fx

    for f in S["laws"]:
        if not f.get("start", 0) <= t < f.get("start", 0) + f.get("duration", math.inf):
            continue
        if f["type"] == "spring":
            i, j = idx[f["body_a"]], idx[f["body_b"]]
            ax, ay, avx, avy, arx, ary = at(i, f["anchor_a"])
            bx, by, bvx, bvy, brx, bry = at(j, f["anchor_b"])
            L = math.hypot(bx - ax, by - ay)
            nx, ny = (bx - ax) / L, (by - ay) / L
            T = f["stiffness"] * (L - f["rest_length"]) + f["damping"] * ((bvx - avx) * nx + (bvy - avy) * ny)
            add(i, T * nx, T * ny, arx, ary)
            add(j, -T * nx, -T * ny, brx, bry)
        else:
            k = idx[f["body"]]
            if f["type"] == "point_force":
                _, _, _, _, rx, ry = at(k, f["point"])
                add(k, *(f["force"] if f["frame"] == "world" else turn(f["force"], q[k][2])), rx, ry)
            elif f["type"] == "torque":
                F[k][2] += f["torque"]
            else:
                add(k, -f["coefficient"] * u[k][0], -f["coefficient"] * u[k][1], 0, 0)
    for k in range(len(q)):
        for d in range(3):
            pull = S["g"][d] if d < 2 and m[k][d] else 0
            u[k][d] += (pull + F[k][d] * m[k][d]) * h


def circle_box(c, r, box, s):
    lx, ly = turn((c[0] - box[0], c[1] - box[1]), -box[2])
    w, t = s["width"] / 2, s["height"] / 2
    px, py = max(-w, min(w, lx)), max(-t, min(t, ly))
    dx, dy = turn((px - lx, py - ly), box[2])
    d = math.hypot(dx, dy)
    if not 0 < d < r:
        return []
    return [((dx / d, dy / d), r - d, (c[0] + dx, c[1] + dy))]


def corners(p, s):
    w, t = s["width"] / 2, s["height"] / 2
    return [(p[0] + x, p[1] + y) for x, y in (turn(c, p[2]) for c in ((w, t), (-w, t), (-w, -t), (w, -t)))]


def box_box(p, s, o, z):
    A, B = corners(p, s), corners(o, z)
    best = None
    for angle, mine in ((p[2], 0), (p[2] + math.pi / 2, 0), (o[2], 1), (o[2] + math.pi / 2, 1)):
        n = (math.cos(angle), math.sin(angle))
        if (o[0] - p[0]) * n[0] + (o[1] - p[1]) * n[1] < 0:
            n = (-n[0], -n[1])
        gap = min(c[0] * n[0] + c[1] * n[1] for c in B) - max(c[0] * n[0] + c[1] * n[1] for c in A)
        if gap >= 0:
            return []
        if best is None or gap > best[0] + 1e-9:
            best = gap, n, mine
    _, n, mine = best
    o_n = (n[0], n[1]) if mine == 0 else (-n[0], -n[1])
    face, other = (A, B) if mine == 0 else (B, A)
    dot = lambda c, d: c[0] * d[0] + c[1] * d[1]
    level = max(dot(c, o_n) for c in face)
    P, Q = sorted(other, key=lambda c: dot(c, o_n))[:2]
    t = (-o_n[1], o_n[0])
    for side in (1, -1):
        d = (t[0] * side, t[1] * side)
        end = max(dot(c, d) for c in face)
        dp, dq = dot(P, d) - end, dot(Q, d) - end
        if dp > 0 and dq > 0:
            return []
        cut = lambda: (P[0] + (Q[0] - P[0]) * dp / (dp - dq), P[1] + (Q[1] - P[1]) * dp / (dp - dq))
        if dp > 0:
            P = cut()
        elif dq > 0:
            Q = cut()
    return [(n, level - dot(c, o_n), c) for c in (P, Q) if dot(c, o_n) < level]


def touching(S, i, j):
    s, z = S["shape"][i], S["shape"][j]
    p, o = S["q"][i], S["q"][j]
    if s["type"] == z["type"] == "circle":
        d = math.hypot(o[0] - p[0], o[1] - p[1])
        if not 0 < d < s["radius"] + z["radius"]:
            return []
        n = ((o[0] - p[0]) / d, (o[1] - p[1]) / d)
        return [(n, s["radius"] + z["radius"] - d, (p[0] + n[0] * s["radius"], p[1] + n[1] * s["radius"]))]
    if s["type"] == "circle":
        return circle_box(p, s["radius"], o, z)
    if z["type"] == "circle":
        return [((-n[0], -n[1]), d, c) for n, d, c in circle_box(o, z["radius"], p, s)]
    return box_box(p, s, o, z)


def pairs(S):
    for i in range(len(S["q"]) - 1):
        for j in range(i):
            if (S["m"][i][0] or S["m"][j][0]) and frozenset((i, j)) not in S["skip"]:
                for n, d, c in touching(S, i, j):
                    yield i, j, n, d, c


class Row:
    """J u = want between two bodies, with an impulse between low and high."""

    def __init__(self, S, i, j, n, ra, rb):
        self.i, self.j = i, j
        self.J = [-n[0], -n[1], -(ra[0] * n[1] - ra[1] * n[0]), n[0], n[1], rb[0] * n[1] - rb[1] * n[0]]
        self.M = S["m"][i] + S["m"][j]
        self.k = sum(a * a * b for a, b in zip(self.J, self.M))
        self.want, self.sum, self.rub, self.mu, self.free = 0.0, 0.0, None, 0.0, True

    def speed(self, S):
        return sum(a * b for a, b in zip(self.J, S["u"][self.i] + S["u"][self.j]))

    def give(self, array, x):
        for d in range(3):
            array[self.i][d] += self.J[d] * self.M[d] * x
            array[self.j][d] += self.J[3 + d] * self.M[3 + d] * x

    def solve(self, S):
        x = (self.want - self.speed(S)) / self.k
        if self.rub is not None:
            most = self.mu * self.rub.sum
            new = max(-most, min(most, self.sum + x))
        elif self.free:
            new = self.sum + x
        else:
            new = max(0, self.sum + x)
        self.give(S["u"], new - self.sum)
        self.sum = new


def contact_rows(S):
    rows = []
    for i, j, n, d, c in pairs(S):
        p, o = S["q"][i], S["q"][j]
        ra, rb = (c[0] - p[0], c[1] - p[1]), (c[0] - o[0], c[1] - o[1])
        row = Row(S, i, j, n, ra, rb)
        row.free = False
        v = row.speed(S)
        if v < -max(2 * math.hypot(*S["g"]) * S["h"], S["rules"]["restitution_threshold"]):
            row.want = -v * MIX[S["rules"]["restitution"]](S["shape"][i]["restitution"], S["shape"][j]["restitution"])
        rows.append(row)
        rub = Row(S, i, j, (-n[1], n[0]), ra, rb)
        rub.rub, rub.mu = row, MIX[S["rules"]["friction"]](S["shape"][i]["friction"], S["shape"][j]["friction"])
        rows.append(rub)
    return rows


def joint_rows(S):
    rows = []
    for i, j, a, b, L, kind in S["joints"]:
        p, o = S["q"][i], S["q"][j]
        ra, rb = turn(a, p[2]), turn(b, o[2])
        C = (o[0] + rb[0] - p[0] - ra[0], o[1] + rb[1] - p[1] - ra[1])
        if kind == "revolute":
            axes = (((1, 0), C[0]), ((0, 1), C[1]))
        else:
            d = math.hypot(*C)
            axes = (((C[0] / d, C[1] / d), d - L),)
        for n, error in axes:
            row = Row(S, i, j, n, ra, rb)
            row.want = -0.2 * error / S["h"]
            rows.append(row)
    return rows


def step(S):
    forces(S)
    rows = joint_rows(S) + contact_rows(S)
    for _ in range(30):
        for row in rows:
            row.solve(S)
    for k, v in enumerate(S["u"]):
        for d in range(3):
            S["q"][k][d] += v[d] * S["h"]
    for i, j, n, d, c in pairs(S):
        p, o = S["q"][i], S["q"][j]
        row = Row(S, i, j, n, (c[0] - p[0], c[1] - p[1]), (c[0] - o[0], c[1] - o[1]))
        row.give(S["q"], 0.4 * max(0, d - 0.0005) / row.k)
    S["n"] += 1


def say(o):
    print(json.dumps(o), flush=True)


def main():
    S = None
    for line in sys.stdin:
        r = json.loads(line)
        if r["request"] == "hello":
            say(HELLO)
        elif r["request"] == "load":
            S = load(r["scene"], r["settings"]["dt"])
            say({"effective_settings": {"dt": r["settings"]["dt"]}})
        elif r["request"] == "run":
            dt = S.get("told", S["h"])
            for _ in range(r["samples"]):
                for _ in range(r["every"]):
                    step(S)
                say({"t": S["n"] * dt, "states": [a + b for a, b in zip(S["q"][:-1], S["u"][:-1])]})
            say({"done": True, "ns": 1000})
        elif r["request"] == "quit":
            return


main()
