#include "engine/encoding/encoding.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>

namespace plumb {

namespace {
enum class Colour { Red, Green };
struct Padded {
  double mass;
  std::int32_t index;
};
struct Listed {
  std::vector<int> numbers;
  std::optional<Padded> one;
  std::variant<int, std::string> either;
};
}  // namespace

template <>
inline constexpr int kEnumerators<Colour> = 2;
PLUMB_MEMBERS(Padded, mass, index)
PLUMB_MEMBERS(Listed, numbers, one, either)

namespace {

static_assert(packed_size<Padded>() == 12, "no padding");
static_assert(!Packed<Listed> && !Packed<std::vector<int>> && !Packed<int*>);

template <class Do>
void expect_refused(const Do& what, const std::string& field) {
  try {
    what();
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value);
    EXPECT_EQ(error.subject(), "snapshot");
    EXPECT_EQ(error.field(), field);
  }
}

TEST(Encoding, ReadsWhatWasWritten) {
  std::vector<std::byte> bytes = {std::byte{9}};
  Encoder out(bytes);
  out.put(-5), out.put(true), out.put(Colour::Green), out.put(std::numeric_limits<double>::quiet_NaN());
  out.put(Vec2<float>{1.5f, -0.0f});
  out.put(std::vector<Padded>{{1, 2}, {3, 4}});
  out.put(Listed{{7, 8}, Padded{5, 6}, "text"});
  EXPECT_EQ(bytes.size(), 1 + 4 + 1 + 1 + 8 + 8 + (8 + 24) + (8 + 8 + 1 + 12 + 1 + 8 + 4u));
  EXPECT_EQ(bytes.front(), std::byte{9}) << "appended";

  Decoder in(std::span<const std::byte>(bytes).subspan(1), "snapshot");
  EXPECT_EQ(in.get<int>("n"), -5);
  EXPECT_TRUE(in.get<bool>("b"));
  EXPECT_EQ(in.get<Colour>("c"), Colour::Green);
  EXPECT_TRUE(std::isnan(in.get<double>("d")));
  const auto vector = in.get<Vec2<float>>("v");
  EXPECT_EQ(vector.x, 1.5f);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(vector.y), 0x80000000u) << "bits, not values";
  std::vector<Padded> padded = {{9, 9}, {9, 9}, {9, 9}};
  in.get(padded, "p");
  ASSERT_EQ(padded.size(), 2u);
  EXPECT_EQ(padded[1].mass, 3);
  EXPECT_EQ(padded[1].index, 4);
  const auto listed = in.get<Listed>("l");
  EXPECT_EQ(listed.numbers, (std::vector{7, 8}));
  EXPECT_EQ(listed.one->index, 6);
  EXPECT_EQ(std::get<std::string>(listed.either), "text");
  EXPECT_TRUE(in.rest().empty());
}

TEST(Encoding, RefusesBytesThatAreCutOff) {
  std::vector<std::byte> bytes;
  Encoder out(bytes);
  out.put(7.0), out.put(std::vector<int>{1, 2, 3}), out.put(std::string("text"));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto read = [&] {
      Decoder in(std::span<const std::byte>(bytes.data(), size), "snapshot");
      in.get<double>("number");
      in.get<std::vector<int>>("numbers");
      in.get<std::string>("text");
    };
    expect_refused(read, size < 8 ? "number" : size < 28 ? "numbers" : "text");
  }
}

// A count that no memory holds must not be tried, nor overflow when it is multiplied.
TEST(Encoding, ComparesCountsWithTheBytesThatFollow) {
  for (const std::uint64_t count : {std::uint64_t{2}, std::uint64_t{1} << 40, std::uint64_t{1} << 61,
                                    std::numeric_limits<std::uint64_t>::max()}) {
    std::vector<std::byte> bytes;
    Encoder out(bytes);
    out.put(count), out.put(std::uint64_t{0});
    expect_refused([&] { Decoder(bytes, "snapshot").get<std::vector<double>>("numbers"); }, "numbers");
    if (count > 8) {
      expect_refused([&] { Decoder(bytes, "snapshot").get<std::string>("name"); }, "name");
      expect_refused([&] { Decoder(bytes, "snapshot").get<std::vector<std::string>>("names"); }, "names");
    }
  }
}

TEST(Encoding, RefusesValuesThatTheTypeDoesNotHave) {
  const std::vector<std::byte> bytes = {std::byte{2}};
  expect_refused([&] { Decoder(bytes, "snapshot").get<bool>("awake"); }, "awake");
  expect_refused([&] { Decoder(bytes, "snapshot").get<Colour>("colour"); }, "colour");
  expect_refused([&] { Decoder(bytes, "snapshot").get<std::variant<int, double>>("kind"); }, "kind");
}

}  // namespace
}  // namespace plumb
