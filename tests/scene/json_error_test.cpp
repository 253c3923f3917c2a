#include <gtest/gtest.h>

#include <algorithm>

#include "engine/scene/json.h"
#include "tests/scene/sample.h"

namespace plumb {
namespace {

using Kind = Error::Kind;

/// `to_json(full_scene())` with one piece of text put in place of another, and what must be said about it.
struct Slip {
  const char* name;
  std::string from, to;
  Kind kind;
  std::string subject, field, value, problem;  ///< `problem` is a part of the text
  std::string line_with;                       ///< text on the line that must be named
};

void PrintTo(const Slip& slip, std::ostream* out) { *out << slip.name; }

int line_of(const std::string& text, const std::string& piece) {
  const auto at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

class ReaderError : public testing::TestWithParam<Slip> {};

TEST_P(ReaderError, NamesLineSubjectFieldAndValue) {
  const Slip& slip = GetParam();
  std::string text = to_json(test::full_scene());
  const auto at = text.find(slip.from);
  ASSERT_NE(at, std::string::npos) << slip.from;
  text.replace(at, slip.from.size(), slip.to);
  const Error error = test::error_of([&] { scene_from_json(text); });
  EXPECT_EQ(error.kind(), slip.kind) << error.what();
  EXPECT_EQ(error.subject(), slip.subject);
  EXPECT_EQ(error.field(), slip.field);
  EXPECT_EQ(error.value(), slip.value);
  EXPECT_NE(error.problem().find(slip.problem), std::string::npos) << error.what();
  EXPECT_EQ(error.line(), line_of(text, slip.line_with)) << error.what();
}

std::string slip_name(const testing::TestParamInfo<Slip>& info) { return info.param.name; }

const std::string kNumberProblem = "must be a number", kVectorProblem = "must be [x, y], two numbers";

const Slip kTypeSlips[] = {
    {"NumberIsString", "\"mass\": 6", "\"mass\": \"heavy\"", Kind::Syntax, "body 'ball'", "mass", "\"heavy\"",
     kNumberProblem, "\"heavy\""},
    {"NumberIsNull", "\"inertia\": 7.5", "\"inertia\": null", Kind::Syntax, "body 'ball'", "inertia", "null",
     kNumberProblem, "null"},
    {"NumberIsBoolean", "\"angle\": 0.5", "\"angle\": true", Kind::Syntax, "body 'ball'", "angle", "true",
     kNumberProblem, "\"angle\": true"},
    {"StringIsNumber", "\"name\": \"floor\"", "\"name\": 17", Kind::Syntax, "body 1", "name", "17",
     "must be a string", "17"},
    {"BooleanIsNumber", "\"collide\": true", "\"collide\": 1", Kind::Syntax, "joint 'hinge'", "collide", "1",
     "true or false", "\"collide\": 1"},
    {"VectorIsNumber", "\"velocity\": [3, 4]", "\"velocity\": 3", Kind::Syntax, "body 'ball'", "velocity",
     "3", kVectorProblem, "\"velocity\": 3"},
    {"VectorIsShort", "[3, 4]", "[3]", Kind::Syntax, "body 'ball'", "velocity", "[3]", kVectorProblem, "[3]"},
    {"VectorIsLong", "[3, 4]", "[3, 4, 5]", Kind::Syntax, "body 'ball'", "velocity", "[3, 4, 5]",
     kVectorProblem, "[3, 4, 5]"},
    {"VectorOfStrings", "[3, 4]", "[\n3,\n\"y\"\n]", Kind::Syntax, "body 'ball'", "velocity", "[3, \"y\"]",
     kVectorProblem, "\"y\""},
    {"ListIsObject", "\"shapes\": []", "\"shapes\": {}", Kind::Syntax, "body 'belt'", "shapes", "{}",
     "must be a list", "\"shapes\": {}"},
    {"ObjectIsList", "{\"category\": 6, \"mask\": 4042322160, \"group\": -3}", "[6]", Kind::Syntax,
     "body 'ball'", "shapes[0].filter", "[6]", "must be an object", "\"filter\": [6]"},
    {"EntryIsNumber", "\"shapes\": []", "\"shapes\": [null]", Kind::Syntax, "body 'belt'", "shapes[0]",
     "null", "must be an object", "[null]"},
};
INSTANTIATE_TEST_SUITE_P(Type, ReaderError, testing::ValuesIn(kTypeSlips), slip_name);

const Slip kNameSlips[] = {
    {"UnknownKey", "\"mass\": 6", "\"mas\": 6", Kind::Syntax, "body 'ball'", "mas", "6",
     "is not a field of a body; did you mean 'mass'?", "\"mas\""},
    {"UnknownKeyAboveItsValue", "\"mass\": 6", "\"mas\":\n\n6", Kind::Syntax, "body 'ball'", "mas", "6",
     "did you mean 'mass'?", "\"mas\""},
    {"UnknownKeyOfScene", "\"gravity\"", "\"gravitiy\"", Kind::Syntax, "scene 'everything'", "gravitiy",
     "[0.1, -1.62]", "is not a field of a scene; did you mean 'gravity'?", "gravitiy"},
    {"KeyOfAnotherShape", "\"radius\": 0.5", "\"width\": 0.5", Kind::Syntax, "body 'ball'", "shapes[0].width",
     "0.5", "is not a field of a circle", "\"width\": 0.5"},
    {"KeyOfAnotherJoint", "\"anchor_a\": [1, 1]", "\"length\": 2", Kind::Syntax, "joint 'hinge'", "length",
     "2", "is not a field of a revolute joint", "\"length\": 2"},
    {"KeyOfAnotherForce", "\"coefficient\": 0.5", "\"torque\": 2", Kind::Syntax,
     "force 0 (linear_drag on 'ball')", "torque", "2", "is not a field of a linear_drag", "\"torque\": 2"},
    {"MistypedType", "\"type\": \"circle\"", "\"typ\": \"circle\"", Kind::Syntax, "body 'ball'",
     "shapes[0].typ", "\"circle\"", "did you mean 'type'?", "\"typ\""},
    {"UnknownBodyType", "\"kinematic\"", "\"cinematic\"", Kind::Name, "body 'belt'", "type", "cinematic",
     "must be 'static', 'kinematic' or 'dynamic'; did you mean 'kinematic'?", "cinematic"},
    {"UnknownShape", "\"circle\"", "\"ellipse\"", Kind::Name, "body 'ball'", "shapes[0].type", "ellipse",
     "must be 'circle', 'box', 'capsule', 'polygon', 'segment' or 'chain'", "ellipse"},
    {"UnknownRule", "\"average\"", "\"avarage\"", Kind::Name, "scene 'everything'", "contact_rules.friction",
     "avarage", "did you mean 'average'?", "avarage"},
    {"UnknownBody", "\"body_b\": \"ball\"", "\"body_b\": \"bal\"", Kind::Name, "joint 'hinge'", "body_b",
     "bal", "did you mean 'ball'?", "\"bal\""},
    {"DuplicateName", "\"name\": \"belt\"", "\"name\": \"ball\"", Kind::Name, "body 'ball'", "name", "ball",
     "must be unique: body 0", "\"name\": \"ball\",\n      \"type\": \"kinematic\""},
    {"DuplicateKey", "\"mass\": 6,", "\"mass\": 6,\n\"mass\": 7,", Kind::Syntax, "body 'ball'", "mass", "7",
     "is given twice", "\"mass\": 7"},
    {"DuplicateEscapedKey", "\"mass\": 6,", "\"mass\": 6,\n\"m\\u0061ss\": 7,", Kind::Syntax, "body 'ball'",
     "mass", "7", "is given twice", "\\u0061"},
    {"EscapedControlCharacter", "\"name\": \"belt\"", "\"name\": \"be\\u0000lt\"", Kind::Name,
     "body 'be\\x00lt'", "name", "be\\x00lt", "control characters", "u0000"},
};
INSTANTIATE_TEST_SUITE_P(Name, ReaderError, testing::ValuesIn(kNameSlips), slip_name);

const Slip kMissingSlips[] = {
    {"Name", "\"name\": \"ball\",", "", Kind::Syntax, "body 0", "name", "absent", "must be given for a body",
     "{\n      \n"},
    {"Radius", "\"radius\": 0.5,", "", Kind::Syntax, "body 'ball'", "shapes[0].radius", "absent",
     "must be given for a circle", "{\n          \"type\": \"circle\""},
    {"Length", "\"length\": 5,", "", Kind::Syntax, "joint 'rod'", "length", "absent",
     "must be given for a distance joint", "{\n      \"type\": \"distance\""},
    {"Type", "\"type\": \"torque\",", "", Kind::Syntax, "force 3 (on 'ball')", "type", "absent",
     "must be given for a force", "{\n      \n"},
};
INSTANTIATE_TEST_SUITE_P(Missing, ReaderError, testing::ValuesIn(kMissingSlips), slip_name);

const Slip kValueSlips[] = {
    {"NegativeMass", "\"mass\": 6", "\"mass\":\n -1\n", Kind::Value, "body 'ball'", "mass", "-1",
     "must be a positive number of kg", " -1\n"},
    {"NegativeRadius", "\"radius\": 0.5", "\"radius\": -0.5", Kind::Value, "body 'ball'", "shapes[0].radius",
     "-0.5", "positive", "-0.5"},
    {"SecondShape", "\"height\": 0.25", "\"height\": 0", Kind::Value, "body 'ball'", "shapes[1].height", "0",
     "positive", "\"height\": 0"},
    {"Threshold", "\"restitution_threshold\": 0.25", "\"restitution_threshold\": -1", Kind::Value,
     "scene 'everything'", "contact_rules.restitution_threshold", "-1", "zero or a positive",
     "_threshold\": -1"},
    {"ThroughAbsence", "\"inertia\": 7.5,",
     "\"inertia\": 7.5, \"fixed_rotation\": true, \"angular_velocity\": 5,", Kind::Syntax, "body 'ball'",
     "angular_velocity", "5", "is given twice", "7.5"},
    {"BeyondDouble", "\"mass\": 6", "\"mass\": 1e999", Kind::Value, "body 'ball'", "mass", "1e999",
     "that a double can hold", "1e999"},
    {"BeyondDoubleNegative", "[3, 4]", "[3,\n-1e400]", Kind::Value, "body 'ball'", "velocity", "-1e400",
     "that a double can hold", "-1e400"},
    {"BeyondTheFormat", "[3, 4]", "[3, 1e101]", Kind::Value, "body 'ball'", "velocity", "[3, 1e+101]",
     "at most", "1e101"},
    {"Underflow", "\"mass\": 6", "\"mass\": 1e-999", Kind::Value, "body 'ball'", "mass", "0", "positive",
     "1e-999"},
    {"MaskTooLarge", "4042322160", "18446744073709551616", Kind::Value, "body 'ball'",
     "shapes[0].filter.mask", "18446744073709551616", "a whole number from -2^63 to 2^64 - 1",
     "18446744073709551616"},
    {"MaskFraction", "4042322160", "77.5", Kind::Value, "body 'ball'", "shapes[0].filter.mask", "77.5",
     "a whole number", "77.5"},
    {"GroupFraction", "\"group\": -3", "\"group\": -3.5", Kind::Value, "body 'ball'",
     "shapes[0].filter.group", "-3.5", "a whole number", "-3.5"},
    {"Version", "\"plumb_scene\": 1", "\"plumb_scene\": 2", Kind::Unsupported, "scene 'everything'",
     "plumb_scene", "2", "must be 1", "\"plumb_scene\""},
    {"ForceStart", "\"start\": 0.5", "\"start\": -0.5", Kind::Value, "force 2 (point_force on 'ball')",
     "start", "-0.5", "zero or a positive", "-0.5"},
    {"StaticMoves", "\"velocity\": [0, 0]", "\"velocity\": [0, 1]", Kind::Value, "body 'floor'", "velocity",
     "[0, 1]", "zero for a static body", "[0, 1]"},
};
INSTANTIATE_TEST_SUITE_P(Value, ReaderError, testing::ValuesIn(kValueSlips), slip_name);

TEST(ReaderErrorLine, OfAFieldThatIsNotThereIsThatOfTheThing) {
  const Error error = test::error_of([] { scene_from_json("{\n\"bodies\": [\n{\n\"name\": \"a\"}]}"); });
  EXPECT_STREQ(error.what(),
               "line 3: body 'a': inertia is absent: must be given in kg m^2 for a dynamic body without "
               "shapes, unless "
               "fixed_rotation is true");
}

TEST(ReaderErrorLine, CountsCarriageReturnsWithTheirLineFeeds) {
  const Error error = test::error_of([] { scene_from_json("{\r\n\"name\":\r\n 5}"); });
  EXPECT_EQ(error.line(), 3);
}

TEST(ReaderErrorLine, OfDuplicateKeysIsTheFirstOne) {
  const Error error = test::error_of([] { scene_from_json("{\"z\": 1,\n\"z\": 2,\n\"a\": 3,\n\"a\": 4}"); });
  EXPECT_EQ(error.line(), 2);
  EXPECT_EQ(error.field(), "z");
}

TEST(ReaderErrorValue, LeavesWhatWasExpected) {
  const std::string text = "{\"" + std::string(100000, 'x') + "\n\": 1}";
  const Error error = test::error_of([&] { scene_from_json(text); });
  EXPECT_LT(error.problem().size(), 300u);
  EXPECT_TRUE(error.problem().ends_with("; expected string literal")) << error.problem();
}

TEST(ReaderErrorValue, StaysShort) {
  const std::string text =
      "{\"name\": [" + std::string(100000, '1') + "e-100000, \"" + std::string(100000, 'x') + "\"]}";
  const Error error = test::error_of([&] { scene_from_json(text); });
  EXPECT_LT(std::string(error.what()).size(), 300u);
}

}  // namespace
}  // namespace plumb
