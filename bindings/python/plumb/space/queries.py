"""Queries of a space: the world's tree finds what is near, the shapes' own geometry decides. Sensors are found."""


from plumb import _plumb
from plumb.space.geometry import cast, nearest, touch
from plumb.space.values import BB, ShapeQueryInfo, Vec2d

_FAR = 1e12  # the greatest coordinate of the world's queries


def _bounded(value):
    return min(max(value, -_FAR), _FAR)


class Queries:
    def _near(self, bb, shape_filter):
        """Returns the shapes that overlap or touch a box and that the filter lets through, by age."""
        found = self._world.overlap_box((_bounded(bb.left), _bounded(bb.bottom)),
                                        (_bounded(bb.right), _bounded(bb.top)), sensors=True)
        return self._let_through(found, shape_filter)

    def _let_through(self, found, shape_filter):
        shapes = (self._of[each.index] for each in found)
        return sorted((s for s in shapes if not s.filter.rejects(shape_filter)), key=lambda s: s._age)

    def point_query(self, point, max_distance, shape_filter):
        point = Vec2d(*point)
        reach = max(max_distance, 0.0)
        near = (nearest(s, point) for s in self._near(BB.newForCircle(point, reach), shape_filter))
        return [hit for hit in near if hit.distance <= max_distance]

    def point_query_nearest(self, point, max_distance, shape_filter):
        point, f = Vec2d(*point), shape_filter
        if f.group == 0 and max_distance >= 0:
            hit = self._world.nearest(point, min(max_distance, _FAR), category=f.categories, mask=f.mask, sensors=True)
            return hit and nearest(self._of[hit["shape"].index], point)
        return min(self.point_query(point, max_distance, f), key=lambda hit: hit.distance, default=None)

    def segment_query(self, start, end, radius, shape_filter):
        start, end = Vec2d(*start), Vec2d(*end)
        size = (end - start).length
        # A little wider than the query, so that rounding loses no shape that it only grazes.
        reach = radius + 1e-9 * (size + radius + start.length + end.length)
        if size > reach > 0:
            swept = _plumb.Capsule((0, 0), end - start, reach)
            found = self._world.overlap_shape(swept, start, sensors=True)
            near = self._let_through(found, shape_filter)
        else:
            box = BB.newForCircle(start, reach).merge(BB.newForCircle(end, reach))
            near = self._near(box, shape_filter)
        casts = (cast(s, start, end, radius) for s in near)
        return [hit for hit in casts if hit is not None]

    def segment_query_first(self, start, end, radius, shape_filter):
        return min(self.segment_query(start, end, radius, shape_filter), key=lambda hit: hit.alpha, default=None)

    def bb_query(self, bb, shape_filter):
        """Returns the shapes that overlap or touch a box: the shapes themselves, not the boxes around them."""
        return self._near(bb, shape_filter)

    def shape_query(self, shape):
        hits = []
        for other in self._near(shape.bb, shape.filter):
            points = touch(shape, other) if other is not shape else None
            if points is not None:
                hits.append(ShapeQueryInfo(other, points))
        return hits
