"""Drawings of the course's geometry. make.py writes them beside the figures."""
import math

INK, BLUE, ORANGE, GREEN, GREY, FILL, WALL = "#222222", "#00468b", "#d95f02", "#2a9d5c", "#777777", "#dfe8f2", "#d8d2c4"


class Drawing:
    """An SVG in pixels; y grows upwards here, as in the scenes."""

    def __init__(self, width, height):
        self.width, self.height, self.parts = width, height, []

    def _y(self, y):
        return self.height - y

    def line(self, a, b, colour=INK, width=2, dashed=False):
        dash = ' stroke-dasharray="5 4"' if dashed else ""
        self.parts.append(f'<line x1="{a[0]:.1f}" y1="{self._y(a[1]):.1f}" x2="{b[0]:.1f}" y2="{self._y(b[1]):.1f}" '
                          f'stroke="{colour}" stroke-width="{width}"{dash}/>')

    def polygon(self, points, fill=FILL, colour=INK):
        text = " ".join(f"{x:.1f},{self._y(y):.1f}" for x, y in points)
        self.parts.append(f'<polygon points="{text}" fill="{fill}" fill-opacity="0.75" stroke="{colour}" stroke-width="1.5"/>')

    def box(self, x, y, w, h, fill=FILL, angle=0.0):
        c, s = math.cos(angle), math.sin(angle)
        corners = [(x + c * a * w / 2 - s * b * h / 2, y + s * a * w / 2 + c * b * h / 2) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        self.polygon(corners, fill)
        return corners

    def circle(self, x, y, r, fill=FILL, colour=INK):
        self.parts.append(f'<circle cx="{x:.1f}" cy="{self._y(y):.1f}" r="{r:.1f}" fill="{fill}" fill-opacity="0.75" '
                          f'stroke="{colour}" stroke-width="1.5"/>')

    def dot(self, x, y, colour=INK):
        self.circle(x, y, 3.5, colour, colour)

    def arrow(self, a, b, colour=BLUE, label="", side=12):
        dx, dy = b[0] - a[0], b[1] - a[1]
        d = math.hypot(dx, dy)
        ux, uy = dx / d, dy / d
        base = (b[0] - 10 * ux, b[1] - 10 * uy)
        self.line(a, base, colour, 2.5)
        self.parts.append('<polygon points="%.1f,%.1f %.1f,%.1f %.1f,%.1f" fill="%s"/>' % (
            b[0], self._y(b[1]), base[0] - 5 * uy, self._y(base[1] + 5 * ux), base[0] + 5 * uy, self._y(base[1] - 5 * ux), colour))
        if label:
            middle = ((a[0] + b[0]) / 2 - side * uy, (a[1] + b[1]) / 2 + side * ux)
            self.text(middle[0], middle[1] - 4, label, colour)

    def text(self, x, y, words, colour=INK, anchor="middle", size=14):
        words = words.replace("&", "&amp;").replace("<", "&lt;")
        self.parts.append(f'<text x="{x:.1f}" y="{self._y(y):.1f}" text-anchor="{anchor}" font-size="{size}" fill="{colour}">{words}</text>')

    def svg(self):
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" width="{self.width}" '
                f'height="{self.height}" font-family="sans-serif">\n<rect width="100%" height="100%" fill="#ffffff"/>\n' +
                "\n".join(self.parts) + "\n</svg>\n")


def products():
    d = Drawing(640, 230)
    a, b, o = (230, 60), (150, 170), (50, 60)
    d.arrow(o, a, BLUE, "a", -14)
    d.arrow(o, b, ORANGE, "b")
    d.line(b, (150, 60), GREY, 1.5, True)
    d.line((50, 52), (150, 52), GREEN, 4)
    d.text(100, 30, "b's share along a", GREEN)
    d.text(165, 8, "a . b = ax bx + ay by = |a| times that share", INK, size=13)
    o2 = (370, 60)
    d.polygon([o2, (530, 60), (590, 160), (430, 160)])
    d.arrow(o2, (530, 60), BLUE, "a", -14)
    d.arrow(o2, (430, 160), ORANGE, "b")
    d.text(490, 108, "area", GREEN)
    d.text(480, 30, "above zero: b is to the left of a", GREEN)
    d.text(480, 8, "a x b = ax by - ay bx = the area", INK, size=13)
    d.text(130, 210, "the dot product, a number", INK, size=15)
    d.text(480, 210, "the cross product, a number too", INK, size=15)
    return d


def bounce():
    d = Drawing(640, 250)
    d.box(320, 25, 600, 50, WALL)
    d.text(70, 20, "wall", GREY)
    for x, label in ((170, "before"), (470, "after")):
        d.circle(x, 90, 40)
        d.dot(x, 90)
        d.text(x, 226, label, INK, size=15)
    d.arrow((110, 190), (170, 90), BLUE, "v", 14)
    d.arrow((110, 190), (110, 90), ORANGE, "(v . n) n", -46)
    d.arrow((110, 90), (170, 90), GREEN)
    d.text(140, 70, "along the wall", GREEN)
    d.arrow((320, 50), (320, 130), INK, "n, length 1", 44)
    d.arrow((470, 90), (530, 170), BLUE, "v'", -12)
    d.arrow((530, 90), (530, 170), ORANGE, "-e (v . n) n", -52)
    d.arrow((470, 90), (530, 90), GREEN)
    d.text(520, 70, "unchanged", GREEN)
    return d


def circles():
    d = Drawing(640, 250)
    d.circle(200, 120, 90)
    d.circle(320, 160, 60)
    d.dot(200, 120)
    d.dot(320, 160)
    d.line((200, 120), (320, 160), GREY, 1.5, True)
    ux, uy = 120 / math.hypot(120, 40), 40 / math.hypot(120, 40)
    d.arrow((200, 120), (200 + 70 * ux, 120 + 70 * uy), ORANGE, "n", 14)
    d.text(185, 105, "a", INK)
    d.text(335, 170, "b", INK)
    d.text(430, 200, "d = |xb - xa|, the dashed line", INK, "start")
    d.text(430, 172, "n = (xb - xa)/d, from a to b", ORANGE, "start")
    d.text(430, 144, "they touch if d < r1 + r2", INK, "start")
    d.text(430, 116, "overlap = r1 + r2 - d", INK, "start")
    d.text(430, 88, "they close if (vb - va) . n < 0", INK, "start")
    d.text(430, 60, "a gets -j n, b gets +j n", BLUE, "start")
    return d


def arm():
    d = Drawing(720, 260)
    d.box(170, 120, 200, 90, angle=0.35)
    c, s = math.cos(0.35), math.sin(0.35)
    p = (170 + c * 100 - s * 45, 120 + s * 100 + c * 45)
    d.dot(170, 120)
    d.arrow((170, 120), p, GREEN, "r", 14)
    d.arrow(p, (p[0] - 10, p[1] + 60), ORANGE, "F", -14)
    d.text(170, 100, "centre of mass", INK, size=13)
    d.text(350, 220, "r runs from the centre to the point, in the world:", INK, "start", 13)
    d.text(350, 200, "turn the body's point by the body's angle", INK, "start", 13)
    d.text(350, 166, "torque = r x F = rx Fy - ry Fx", ORANGE, "start")
    d.text(350, 132, "the point moves with v + w x r:", BLUE, "start")
    d.text(350, 110, "(vx - w ry, vy + w rx)", BLUE, "start")
    d.text(350, 76, "an impulse j n there: v += j n/m,", INK, "start")
    d.text(350, 54, "w += (r x n) j/I", INK, "start")
    return d


def inertia():
    d = Drawing(640, 270)
    d.text(160, 250, "the same long side", INK, size=15)
    d.box(85, 150, 120, 120)
    d.box(235, 150, 120, 16)
    d.text(85, 60, "I = m (1 + 1)/12", INK, size=13)
    d.text(235, 60, "I = m (1 + 0.018)/12", INK, size=13)
    d.text(160, 30, "the thin one is easier to spin: 0.51 times I", GREEN)
    d.text(480, 250, "the same area", INK, size=15)
    d.box(400, 150, 70, 70)
    d.box(530, 150, 190, 26)
    d.text(400, 60, "I = m (1 + 1)/12", INK, size=13)
    d.text(535, 60, "I = m (7.4 + 0.14)/12", INK, size=13)
    d.text(480, 30, "the thin one is harder to spin: 3.8 times I", ORANGE)
    return d


def least_overlap():
    d = Drawing(700, 240)
    d.box(180, 80, 240, 80, WALL)
    d.box(280, 140, 120, 80)
    d.line((220, 100), (300, 100), GREY, 1)
    d.arrow((300, 60), (220, 60), BLUE)
    d.arrow((220, 60), (300, 60), BLUE)
    d.text(260, 42, "overlap along x", BLUE)
    d.arrow((330, 100), (330, 120), ORANGE)
    d.arrow((330, 120), (330, 100), ORANGE)
    d.text(400, 106, "along y", ORANGE)
    d.arrow((280, 140), (280, 205), ORANGE, "n", -14)
    d.text(470, 200, "overlap along x =", INK, "start", 13)
    d.text(470, 182, "wa/2 + wb/2 - |xb - xa|", BLUE, "start", 13)
    d.text(470, 156, "the axis with the least one", INK, "start", 13)
    d.text(470, 138, "is the way out: here y", ORANGE, "start", 13)
    d.text(470, 78, "not above 0 along one axis:", INK, "start", 13)
    d.text(470, 60, "the boxes do not touch", INK, "start", 13)
    return d


def clipping():
    d = Drawing(660, 260)
    for i, title in enumerate(("1. the axis of least overlap", "2. the side that faces it", "3. clip, and keep what is behind")):
        x = 110 + 210 * i
        d.text(x, 242, title, INK, size=13)
        d.box(x, 70, 160, 80, WALL)
        corners = d.box(x + 50, 150, 100, 100, angle=0.25)
        low = sorted(corners, key=lambda corner: corner[1])[:2]
        if i == 0:
            d.arrow((x - 30, 110), (x - 30, 170), ORANGE, "n", -12)
            d.line((x - 80, 110), (x + 80, 110), ORANGE, 3)
            d.text(x - 30, 90, "the face", ORANGE, size=12)
        if i >= 1:
            d.line(low[0], low[1], BLUE, 4)
            d.dot(*low[0], BLUE)
            d.dot(*low[1], BLUE)
        if i == 2:
            d.line((x + 80, 30), (x + 80, 190), GREY, 1.5, True)
            a, b = low
            share = (x + 80 - a[0]) / (b[0] - a[0])
            cut = (x + 80, a[1] + share * (b[1] - a[1]))
            d.dot(*cut, ORANGE)
            d.dot(*a, ORANGE)
            d.text(x - 20, 12, "orange: the contact points", ORANGE, size=12)
    return d


def friction():
    d = Drawing(700, 210)
    d.box(200, 25, 360, 50, WALL)
    d.box(200, 90, 120, 80)
    d.arrow((200, 90), (300, 90), BLUE, "v")
    d.arrow((200, 50), (200, 130), GREEN, "N, along n", 46)
    d.arrow((200, 52), (120, 52), ORANGE, "friction", -14)
    d.text(420, 160, "friction is at most mu N,", INK, "start")
    d.text(420, 138, "against the sliding along the surface", INK, "start", 13)
    d.text(420, 106, "sliding: exactly mu N", ORANGE, "start")
    d.text(420, 76, "at rest: what keeps it at rest", ORANGE, "start")
    d.text(420, 46, "on the level: a = mu g", INK, "start")
    return d


def joints():
    d = Drawing(640, 230)
    d.circle(60, 110, 30)
    d.circle(230, 150, 22)
    d.dot(60, 110)
    d.dot(230, 150)
    d.arrow((60, 110), (226, 149), ORANGE, "xb - xa", 14)
    d.text(145, 40, "a stick: C = |xb - xa| - L", INK)
    d.text(145, 20, "it must stay 0", GREY, size=13)
    d.box(400, 110, 120, 40)
    d.box(510, 150, 40, 120, angle=0.3)
    d.dot(400, 110)
    d.dot(510, 150)
    d.arrow((400, 110), (458, 110), GREEN, "ra", 14)
    d.arrow((510, 150), (525, 98), GREEN, "rb", 16)
    d.arrow((460, 108), (523, 97), ORANGE, "C", -14)
    d.text(470, 40, "a hinge: C = xb + rb - xa - ra", INK)
    d.text(470, 20, "both components must stay 0", GREY, size=13)
    return d


def ragdoll():
    d = Drawing(680, 350)
    k, x0, y0 = 180, 170, 195  # px a metre, and the torso's centre
    parts = [("torso 20 kg, 0.35 x 0.7", 0, 0, 0.35, 0.7), ("arm 5 kg, 0.5 x 0.12", -0.45, 0.25, 0.5, 0.12), ("", 0.45, 0.25, 0.5, 0.12),
             ("leg 5 kg, 0.12 x 0.6", -0.15, -0.65, 0.12, 0.6), ("", 0.15, -0.65, 0.12, 0.6)]
    for _, x, y, w, h in parts:
        d.box(x0 + k * x, y0 + k * y, k * w, k * h)
    d.circle(x0, y0 + k * 0.52, k * 0.13)
    for x, y in ((0, 0.37), (-0.2, 0.25), (0.2, 0.25), (-0.15, -0.35), (0.15, -0.35)):
        d.dot(x0 + k * x, y0 + k * y, ORANGE)
    lines = [("sizes in m, masses in kg", INK), ("head: radius 0.13, 4 kg", INK), ("torso: 0.35 x 0.7, 20 kg", INK), ("arms: 0.5 x 0.12, 5 kg each", INK),
             ("legs: 0.12 x 0.6, 5 kg each", INK), ("orange: hinges, at (0, 0.37), (-0.2, 0.25),", ORANGE), ("(0.2, 0.25), (-0.15, -0.35), (0.15, -0.35)", ORANGE),
             ("from the torso's centre", ORANGE), ("limits for a natural look: neck 0.5 rad,", INK), ("shoulders 2, hips 1.2, either way", INK)]
    for i, (line, colour) in enumerate(lines):
        d.text(350, 280 - 24 * i, line, colour, "start", 13)
    return d


DRAWINGS = {"products": products, "bounce_geometry": bounce, "circles": circles, "arm": arm, "inertia": inertia, "least_overlap": least_overlap,
            "clipping": clipping, "friction": friction, "joints": joints, "ragdoll": ragdoll}


def write(folder):
    for name, draw in DRAWINGS.items():
        (folder / f"{name}.svg").write_text(draw().svg())
