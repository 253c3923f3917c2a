#pragma once

#include "engine/world/definitions.h"
#include "engine/world/state/query_shape.h"
#include "tests/fuzz/support/byte_source.h"

/// Parts of a world, drawn from bytes: metres and kilograms as games have them, and anything at all in
/// extreme runs.
namespace plumb::fuzz {

WorldDefinition draw_world(ByteSource& in);
BodyDefinition draw_body(ByteSource& in);
MassProperties draw_mass(ByteSource& in);
Material draw_material(ByteSource& in);
Filter draw_filter(ByteSource& in);
ShapeGeometry draw_geometry(ByteSource& in);
ShapeDefinition draw_shape(ByteSource& in);
ChainDefinition draw_chain(ByteSource& in);
JointKind draw_joint_kind(ByteSource& in, int kind);
JointDefinition draw_joint(ByteSource& in);

}  // namespace plumb::fuzz
