// Every call of a world that takes a number or a handle, with every bad one.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "tests/bad_input/handle_calls.h"
#include "tests/bad_input/number_calls.h"
#include "tests/bad_input/refusal.h"

namespace plumb::bad_input {
namespace {

bool whole(const std::string& field) {
  for (const char* name : {"substeps", "iterations", "threads", "solver", "type", "falloff", "frames"}) {
    if (field == name) return true;
  }
  return false;
}

template <class Real>
class WorldCalls : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(WorldCalls, Reals);

TYPED_TEST(WorldCalls, BadNumbersAreRefusedAndChangeNothing) {
  int refused = 0, accepted = 0;
  for (const NumberCall<TypeParam>& call : number_calls<TypeParam>()) {
    for (const double bad : bad_numbers()) {
      const bool integer = whole(call.field);
      // Solver and Falloff are not made from what does not fit them.
      if (integer && !can_hold<int>(bad)) continue;
      if (call.field == "solver" && !can_hold<std::uint8_t>(bad)) continue;
      if (call.field == "type" && !can_hold<std::uint8_t>(bad)) continue;
      const std::string text = integer ? text_of<int>(bad) : text_of<double>(bad);
      SCOPED_TRACE(call.call + ": " + call.field + " = " + text);
      Things<TypeParam> things;
      if (!call.rule.accepts(bad)) {
        expect_refused(things.world, {call.subject, call.field, text}, [&] { call.run(things, bad); });
        ++refused;
      } else {
        const std::vector<std::byte> before = save(things.world);
        try {
          call.run(things, bad);
          ++accepted;
          expect_finite_steps(things.world);
        } catch (const Error& error) {
          // Too much together with the rest: a velocity that gets there in so short a time.
          const bool step = call.call == "step";
          EXPECT_EQ(error.kind(), step ? Error::Kind::Run : Error::Kind::Value) << error.what();
          EXPECT_TRUE(step || save(things.world) == before) << "something has changed: " << error.what();
        }
      }
    }
  }
  EXPECT_GT(refused, 1500);
  EXPECT_GT(accepted, 500);
}

/// Nothing, what was never made, what is another thing's by now.
template <class Id>
std::vector<Id> bad_handles(Id good) {
  return {Id{},
          {good.index + 1000, good.generation},
          {good.index, good.generation + 2},
          {good.index, good.generation + 1},
          {0x7FFFFFFF, good.generation},
          {0x80000000u, 1},
          {good.index, 0}};
}

template <class Real, class Id>
void expect_gone(Things<Real>& things, const std::string& name,
                 const std::function<void(Things<Real>&, Id)>& run, Id id) {
  SCOPED_TRACE(name + " with " + std::to_string(id.index) + ", " + std::to_string(id.generation));
  const std::vector<std::byte> before = save(things.world);
  try {
    run(things, id);
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Name) << error.what();
    EXPECT_EQ(error.field(), "handle");
  }
  EXPECT_TRUE(save(things.world) == before) << "something has changed";
}

TYPED_TEST(WorldCalls, BadHandlesAreRefusedAndChangeNothing) {
  using Real = TypeParam;
  int tried = 0;
  const auto refuse_all = [&](const auto& calls, auto good, auto member) {
    for (const auto& [name, run] : calls) {
      Things<Real> things;
      for (const auto id : bad_handles(good)) expect_gone(things, name, run, id), ++tried;
      const auto gone = things.*member;
      things.world.destroy(gone);
      ASSERT_FALSE(things.world.valid(gone));
      expect_gone(things, name, run, gone);
    }
  };
  const Things<Real> sample;
  refuse_all(body_calls<Real>(), sample.ball, &Things<Real>::ball);
  refuse_all(shape_calls<Real>(), sample.sensor, &Things<Real>::sensor);
  refuse_all(chain_calls<Real>(), sample.chain, &Things<Real>::chain);
  refuse_all(joint_calls<Real>(), sample.joint, &Things<Real>::joint);
  EXPECT_GT(tried, 500);
}

// ---- The lists are complete

struct Declared {
  std::string name;
  bool handle = false;  ///< takes one
  bool number = false;  ///< likewise, or a vector
};

/// The functions that a header declares: as plain text, without its comments.
std::vector<Declared> declared_in(const std::string& header) {
  std::ifstream in(std::filesystem::path(PLUMB_ENGINE) / "world" / header);
  EXPECT_TRUE(in) << header << " cannot be read; this test needs the sources";
  std::string text;
  for (std::string line; std::getline(in, line);) text += line.substr(0, line.find("//")) + " ";
  text = text.substr(0, text.find(" private:"));
  std::vector<Declared> all;
  static const std::regex kFunction(R"((\w+)\(([^()]*)\)( const)?;)");
  // Defaults have parentheses of no interest.
  text = std::regex_replace(text, std::regex(R"( = [^,();]*)"), "");
  for (std::sregex_iterator it(text.begin(), text.end(), kFunction), end; it != end; ++it) {
    const std::string arguments = (*it)[2];
    static const std::regex kHandle(R"((^|[ (])(Body|Shape|Chain|Joint)Id )"),
        kNumber(R"(\b(double|int|Vec2d)\b)");
    all.push_back({(*it)[1], std::regex_search(arguments, kHandle), std::regex_search(arguments, kNumber)});
  }
  return all;
}

TEST(WorldCallLists, NameEveryFunctionThatTakesANumberOrAHandle) {
  std::set<std::string> numbers, handles;
  for (const auto& call : number_calls<double>()) numbers.insert(call.call);
  for (const auto& [name, run] : body_calls<double>()) handles.insert(name);
  for (const auto& [name, run] : shape_calls<double>()) handles.insert(name);
  for (const auto& [name, run] : chain_calls<double>()) handles.insert(name);
  for (const auto& [name, run] : joint_calls<double>()) handles.insert(name);
  // Any handle is a good question to these.
  handles.insert("valid");
  int found = 0;
  for (const char* header : {"world.h", "queries.h", "force_laws.h", "mover.h"}) {
    for (const Declared& each : declared_in(header)) {
      found += each.number || each.handle ? 1 : 0;
      EXPECT_TRUE(!each.number || numbers.count(each.name)) << each.name << " of " << header;
      EXPECT_TRUE(!each.handle || handles.count(each.name)) << each.name << " of " << header;
    }
  }
  EXPECT_GT(found, 90) << "the headers were not understood";
}

}  // namespace
}  // namespace plumb::bad_input
