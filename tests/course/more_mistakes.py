"""Mistakes for common_mistakes.py, written before anyone looked at which mistakes `plumb check` knows."""

WHOLE, ROWS = "whole_engine", "rows"

# name, the file and its first chapter, the edits (old text, new text), the names that describe it or what comes of it
MISTAKES = [
    ("the step in whole milliseconds", ROWS, 1,
     [("S = {\"h\": dt,",
       "S = {\"h\": int(dt * 1000) / 1000, \"told\": dt,")],
     "wrong_dt"),
    ("a bounce asks for the whole speed", "chapter1", 1,
     [("self.restitution(ball, wall, -closing)",
       "self.restitution(ball, wall, ball.velocity.length())")],
     "threshold_of_whole_speed"),
    ("slow bodies are not moved", WHOLE, 1,
     [("            if b.dyn:\n"
       "                b.x += b.vx * self.dt",
       "            if b.dyn and hypot(b.vx, b.vy) > 0.1:\n"
       "                b.x += b.vx * self.dt")],
     "slow_is_stopped"),
    ("a damper against the whole velocity", ROWS, 2,
     [("            T = f[\"stiffness\"] * (L - f[\"rest_length\"]) + f[\"damping\"] * ((bvx - avx) * nx + (bvy - avy) * ny)\n"
       "            add(i, T * nx, T * ny, arx, ary)\n"
       "            add(j, -T * nx, -T * ny, brx, bry)",
       "            T = f[\"stiffness\"] * (L - f[\"rest_length\"])\n"
       "            fx, fy = T * nx + f[\"damping\"] * (bvx - avx), T * ny + f[\"damping\"] * (bvy - avy)\n"
       "            add(i, fx, fy, arx, ary)\n"
       "            add(j, -fx, -fy, brx, bry)")],
     "damping_not_along_spring"),
    ("each component within 10 m/s", WHOLE, 1,
     [("                b.w += b.torque * b.ii * h\n",
       "                b.w += b.torque * b.ii * h\n"
       "                b.vx, b.vy = min(max(b.vx, -10.0), 10.0), min(max(b.vy, -10.0), 10.0)\n")],
     "speed_limited"),
    ("a spring by its strain", "chapter2", 2,
     [("law[\"stiffness\"] * (length - law[\"rest_length\"])",
       "law[\"stiffness\"] * (length - law[\"rest_length\"]) / (law[\"rest_length\"] or 1)")],
     "spring_by_strain"),
    ("circles are compared within cells of 1 m", WHOLE, 3,
     [("                if (a.dyn or b.dyn) and (id(a), id(b)) not in self.joined:\n",
       "                if (a.dyn or b.dyn) and (id(a), id(b)) not in self.joined:\n"
       "                    if a.r and b.r and (int(a.x // 1), int(a.y // 1)) != (int(b.x // 1), int(b.y // 1)):\n"
       "                        continue\n")],
     "place_matters no_detection"),
    ("one sum of impulses for each body", ROWS, 3,
     [("            new = max(0, self.sum + x)\n",
       "            new = max(0, sums.get(self.i, 0) + x)\n"),
      ("        self.give(S[\"u\"], new - self.sum)\n"
       "        self.sum = new",
       "        if self.rub is None and not self.free:\n"
       "            self.give(S[\"u\"], new - sums.get(self.i, 0))\n"
       "            self.sum = sums[self.i] = new\n"
       "        else:\n"
       "            self.give(S[\"u\"], new - self.sum)\n"
       "            self.sum = new"),
      ("    for _ in range(30):\n",
       "    sums.clear()\n"
       "    for _ in range(30):\n"),
      ("class Row:",
       "sums = {}\n"
       "\n"
       "\n"
       "class Row:")],
     "sum_shared"),
    ("d^2 < r1^2 + r2^2", "chapter3", 3,
     [("        if 0 < distance < reach:",
       "        if 0 < distance and distance ** 2 < a.radius ** 2 + b.radius ** 2:")],
     "sum_of_squared_radii"),
    ("boxes keep their first axes", WHOLE, 4,
     [("        self.a = b[\"angle\"]\n",
       "        self.a = self.a0 = b[\"angle\"]\n"),
      ("    def local(self, wx, wy):",
       "    def first(self, px, py):\n"
       "        c, s = cos(self.a0), sin(self.a0)\n"
       "        return c * px - s * py, s * px + c * py\n"
       "\n"
       "    def local(self, wx, wy):"),
      ("nx, ny = box.point(lx, ly)",
       "nx, ny = box.first(lx, ly)"),
      ("cx, cy = other.point(sx * other.hw, sy * other.hh)",
       "cx, cy = other.first(sx * other.hw, sy * other.hh)"),
      ("xx, xy = box.point(1, 0)",
       "xx, xy = box.first(1, 0)"),
      ("yx, yy = box.point(0, 1)",
       "yx, yy = box.first(0, 1)")],
     "first_angle_kept"),
    ("friction from the weight", ROWS, 4,
     [("most = self.mu * self.rub.sum",
       "most = self.mu * math.hypot(*S[\"g\"]) * S[\"h\"] / (self.M[0] + self.M[3])")],
     "friction_without_normal"),
    ("boxes touch between their centres", "chapter4", 4,
     [("        other, out = (b, normal) if face_of is a else (a, -normal)  # out of the box with the face\n",
       "        return [Contact(a, b, normal, least, (a.position + b.position) * 0.5)]\n"
       "        other, out = (b, normal) if face_of is a else (a, -normal)  # out of the box with the face\n")],
     "contact_between_centres"),
    ("joints are springs", ROWS, 5,
     [("    rows = joint_rows(S) + contact_rows(S)\n",
       "    for row in joint_rows(S):\n"
       "        row.give(S[\"u\"], (2000 * row.want * S[\"h\"] / 0.2 - 20 * row.speed(S)) * S[\"h\"])\n"
       "    rows = contact_rows(S)\n")],
     "joint_as_spring"),
    ("each joint 25 times before the next", WHOLE, 5,
     [("        for _ in range(SWEEPS):\n"
       "            for joint in self.joints:\n"
       "                self.solve_joint(joint)\n"
       "            for c in found:\n"
       "                self.solve_contact(c)\n",
       "        for joint in self.joints:\n"
       "            for _ in range(SWEEPS):\n"
       "                self.solve_joint(joint)\n"
       "        for c in found:\n"
       "            for _ in range(SWEEPS):\n"
       "                self.solve_contact(c)\n")],
     "too_few_iterations"),
    ("joints are corrected with arms of before", WHOLE, 5,
     [("    def arm(self):\n"
       "        return self.body.point(self.px, self.py)",
       "    def keep(self):\n"
       "        self.kept = self.body.point(self.px, self.py)\n"
       "\n"
       "    def arm(self):\n"
       "        return self.kept"),
      ("        self.apply_forces()\n"
       "        found",
       "        self.apply_forces()\n"
       "        for p, q, _ in self.joints:\n"
       "            p.keep()\n"
       "            q.keep()\n"
       "        found")],
     "joint_arms_of_before"),
    ("only the last pair does not collide", "chapter5", 5,
     [("        self.apart = {pair for joint in self.joints if not joint.collide\n"
       "                      for pair in ((joint.a, joint.b), (joint.b, joint.a))}  # joined bodies do not collide\n",
       "        self.apart = set()\n"
       "        for joint in self.joints:\n"
       "            if not joint.collide:\n"
       "                self.apart = {(joint.a, joint.b), (joint.b, joint.a)}\n")],
     "joined_bodies_collide"),
    ("half a side is side // 2", "chapter1", 1,
     [("Vec(shape[\"width\"] / 2, shape[\"height\"] / 2)",
       "Vec(shape[\"width\"] // 2, shape[\"height\"] // 2)")],
     "integer_division"),
    ("a h^2/2 beside the new velocity", WHOLE, 1,
     [("                b.x += b.vx * self.dt\n"
       "                b.y += b.vy * self.dt\n",
       "                b.x += b.vx * self.dt + 0.5 * self.g[0] * self.dt ** 2\n"
       "                b.y += b.vy * self.dt + 0.5 * self.g[1] * self.dt ** 2\n")],
     "half_a_step_twice"),
    ("the floor is y = 0", "chapter1", 1,
     [("        way = ball.position - wall.nearest_to(ball.position)  # from the wall to the ball's centre\n",
       "        way = Vec(0, ball.position.y)\n")],
     "walls_hard_coded"),
    ("y moves with the old velocity", WHOLE, 1,
     [("        self.apply_forces()\n        found = self.contacts()",
       "        for b in self.bodies:\n            b.old = b.vy\n        self.apply_forces()\n        found = self.contacts()"),
      ("                b.y += b.vy * self.dt\n",
       "                b.y += (b.old if not any(b in (c[\"a\"], c[\"b\"]) for c in found) else b.vy) * self.dt\n")],
     "explicit_euler"),
    ("a ball is a square at walls", ROWS, 1,
     [("    dx, dy = turn((px - lx, py - ly), box[2])\n    d = math.hypot(dx, dy)\n    if not 0 < d < r:\n        return []\n",
       "    if abs(lx) >= w + r or abs(ly) >= t + r:\n        return []\n"
       "    ox, oy = w + r - abs(lx), t + r - abs(ly)\n"
       "    n = turn((-math.copysign(1, lx), 0) if ox < oy else (0, -math.copysign(1, ly)), box[2])\n"
       "    dx, dy = turn((px - lx, py - ly), box[2])\n"
       "    return [(n, min(ox, oy), (c[0] + dx, c[1] + dy))]\n"
       "    d = 1\n")],
     "circles_as_squares"),
    ("all divide by the first mass", "chapter2", 2,
     [("(self.gravity + body.force * body.inverse_mass)",
       "(self.gravity + body.force * self.bodies[0].inverse_mass)")],
     "mass_of_another"),
    ("damping by the sum of the velocities", WHOLE, 2,
     [("rate = (bvx - avx) * dx + (bvy - avy) * dy\n                force",
       "rate = (bvx + avx) * dx + (bvy + avy) * dy\n                force")],
     "damping_by_sum"),
    ("drag against the position", ROWS, 2,
     [("add(k, -f[\"coefficient\"] * u[k][0], -f[\"coefficient\"] * u[k][1], 0, 0)",
       "add(k, -f[\"coefficient\"] * q[k][0], -f[\"coefficient\"] * q[k][1], 0, 0)")],
     "drag_of_another_vector"),
    ("each is moved by the whole overlap", WHOLE, 3,
     [("                push = SHARE * max(0.0, depth - SLOP) / inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)\n"
       "                a.shift(-push * nx, -push * ny, rax, ray)\n                b.shift(push * nx, push * ny, rbx, rby)\n        self.n",
       "                if a.dyn: a.x -= depth * nx; a.y -= depth * ny\n"
       "                if b.dyn: b.x += depth * nx; b.y += depth * ny\n        self.n")],
     "correction_split_evenly"),
    ("the mean mass", ROWS, 3,
     [("        self.k = sum(a * a * b for a, b in zip(self.J, self.M))\n",
       "        self.k = sum(a * a * b for a, b in zip(self.J, self.M))\n"
       "        if self.M[0] and self.M[3] and not (self.J[2] * self.M[2] or self.J[5] * self.M[5]):\n"
       "            self.k = 2 / (1 / self.M[0] + 1 / self.M[3])\n")],
     "masses_wrong"),
    ("the head-on formula for whole vectors", "chapter3", 3,
     [("        before = contact.total\n        contact.total = max(0.0, before + j)\n",
       "        a, b = contact.a, contact.b\n"
       "        if a.moves and b.moves:\n"
       "            if contact.bounce and not contact.total:\n"
       "                e, m, n = contact.bounce / -self.closing(contact), 1 / a.inverse_mass, 1 / b.inverse_mass\n"
       "                p = a.velocity * m + b.velocity * n\n"
       "                u, v = a.velocity, b.velocity\n"
       "                a.velocity = (p + (v - u) * (n * e)) * (1 / (m + n))\n"
       "                b.velocity = (p + (u - v) * (m * e)) * (1 / (m + n))\n"
       "                contact.total = 1e-12\n"
       "                return\n"
       "            if contact.total:\n"
       "                return\n"
       "        before = contact.total\n        contact.total = max(0.0, before + j)\n")],
     "whole_velocity"),
    ("a pair that is apart ends the loop", WHOLE, 3,
     [("                if (a.dyn or b.dyn) and (id(a), id(b)) not in self.joined:\n                    yield a, b",
       "                if (a.dyn or b.dyn) and (id(a), id(b)) not in self.joined:\n"
       "                    if not self.touch(a, b):\n                        break\n                    yield a, b")],
     "pairs_left_out pairs_missed"),
    ("a box has the inertia of the disc around it", "chapter4", 4,
     [("inertia = mass * (4 * self.half.x ** 2 + 4 * self.half.y ** 2) / 12",
       "inertia = mass * self.half.length() ** 2 / 2")],
     "inertia_wrong"),
    ("static bodies have inertia", "chapter4", 4,
     [("turns = self.moves and inertia and not",
       "turns = inertia and not")],
     "static_has_mass"),
    ("the tangent is not normalised", WHOLE, 4,
     [("        tx, ty = -ny, nx\n        vx, vy = self.relative(c)\n        j = -(vx * tx + vy * ty) / c[\"kt\"]",
       "        vx, vy = self.relative(c)\n        vn = vx * nx + vy * ny\n        tx, ty = vx - vn * nx, vy - vn * ny\n"
       "        j = -(vx * tx + vy * ty) / c[\"kt\"]")],
     "tangent_not_unit"),
    ("torques are not cleared", "chapter4", 4,
     [("            body.torque = 0.0\n        super().accelerate()",
       "            pass\n        super().accelerate()")],
     "force_not_cleared"),
    ("a hinge is a stick of length 0", WHOLE, 5,
     [("        if length is None:\n            axes = ((1.0, 0.0), (0.0, 1.0))\n        else:\n"
       "            dx, dy = b.x + rbx - a.x - rax, b.y + rby - a.y - ray\n            d = hypot(dx, dy)\n",
       "        if True:\n"
       "            dx, dy = b.x + rbx - a.x - rax, b.y + rby - a.y - ray\n            d = hypot(dx, dy)\n"
       "            if d < 1e-12:\n                return\n")],
     "passes"),
    ("the error of a stick in squares", ROWS, 5,
     [("axes = (((C[0] / d, C[1] / d), d - L),)",
       "axes = (((C[0] / d, C[1] / d), d * d - L * L),)")],
     "passes"),
    ("a stick has the length of the start", "chapter5", 5,
     [("        self.length = scene.get(\"length\")\n",
       "        way = self.b.position - self.a.position\n        self.length = way.length()\n")],
     "length_of_start"),
    ("the whole velocity is scaled", "chapter1", 1,
     [("            ball.velocity -= normal * ((1 + self.restitution(ball, wall, -closing)) * closing)",
       "            e = self.restitution(ball, wall, -closing)\n"
       "            ball.velocity -= normal * (2 * closing)\n"
       "            ball.velocity *= e")],
     "along_wall_changed"),
    ("a spring's direction by its rest length", "chapter2", 2,
     [("direction = way * (1 / length)",
       "direction = way * (1 / (law[\"rest_length\"] or 1))")],
     "spring_not_unit"),
    ("a bounce anew in each sweep, after the first as well", "chapter3", 3,
     [("        j = (contact.bounce - self.closing(contact))",
       "        self.prepare(contact) if contact.bounce else None\n"
       "        j = (contact.bounce - self.closing(contact))")],
     "restitution_ignored"),
    ("impulses of the last step applied and not summed", WHOLE, 3,
     [("        found = self.contacts()\n"
       "        for _ in range(SWEEPS):",
       "        found = self.contacts()\n"
       "        old, self.old = getattr(self, 'old', {}), {}\n"
       "        seen = {}\n"
       "        for c in found:\n"
       "            p = id(c['a']), id(c['b'])\n"
       "            seen[p] = seen.get(p, 0) + 1\n"
       "            c['key'] = p + (seen[p],)\n"
       "            j = old.get(c['key'], 0.0)\n"
       "            self.apply(c, j * c['n'][0], j * c['n'][1])\n"
       "        for _ in range(SWEEPS):"),
      ("        self.n += 1\n",
       "        for c in found:\n"
       "            self.old[c['key']] = c['sum']\n"
       "        self.n += 1\n")],
     "warm_start_not_summed"),
    ("a normal in the frame of a turned box", "chapter4", 4,
     [("    def touch(self, a, b):\n",
       "    def touch_box(self, circle, box):\n"
       "        local = (circle.position - box.position).turned(-box.angle)\n"
       "        near = Vec(min(max(local.x, -box.half.x), box.half.x), min(max(local.y, -box.half.y), box.half.y))\n"
       "        way = near - local\n"
       "        distance = way.length()\n"
       "        if not 0 < distance < circle.radius:\n"
       "            return []\n"
       "        return [Contact(circle, box, way * (1 / distance), circle.radius - distance, box.position + near.turned(box.angle))]\n"
       "\n"
       "    def touch(self, a, b):\n")],
     "box_not_turned"),
    ("a side clipped at one end", "chapter4", 4,
     [("for side in (along, -along):",
       "for side in (along,):")],
     "not_clipped"),
    ("x and y of a hinge from one velocity", WHOLE, 5,
     [("        for nx, ny in axes:\n"
       "            avx, avy = a.velocity(rax, ray)\n"
       "            bvx, bvy = b.velocity(rbx, rby)\n",
       "        avx, avy = a.velocity(rax, ray)\n"
       "        bvx, bvy = b.velocity(rbx, rby)\n"
       "        for nx, ny in axes:\n")],
     "passes"),
    ("a joint's error as a speed", WHOLE, 5,
     [("            j = -rate / inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)\n"
       "            a.impulse",
       "            dx, dy = b.x + rbx - a.x - rax, b.y + rby - a.y - ray\n"
       "            error = dx * nx + dy * ny - (length or 0)\n"
       "            j = (-rate - 0.2 * error) / inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)\n"
       "            a.impulse"),
      ("        for _ in range(FIXES):\n"
       "            for joint in self.joints:\n"
       "                self.fix_joint(joint)\n",
       "")],
     "bias_without_dt"),
]
