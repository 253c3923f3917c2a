#include "engine/scene/bytes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace plumb {

namespace {
struct Filled {
  float mass;
  std::int32_t index;
};
struct Padded {
  double mass;
  std::int32_t index;
};
struct Counted {
  std::int32_t a, b;
};
}  // namespace

template <>
inline constexpr bool kWholeBytes<Filled> = members_fill<Filled, float, std::int32_t>();
template <>
inline constexpr bool kWholeBytes<Padded> = members_fill<Padded, double, std::int32_t>();

namespace {

static_assert(Bytewise<int> && Bytewise<float> && Bytewise<bool> && Bytewise<Vec2<float>> &&
              Bytewise<Counted>);
static_assert(Bytewise<Filled> && Bytewise<Rotation<double>>);
static_assert(!Bytewise<Padded>, "four bytes that are no member's");
static_assert(!Bytewise<long double> && !Bytewise<int*> && !Bytewise<std::vector<int>>);
static_assert(!Bytewise<std::pair<float, float>>, "nobody has said so");

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

TEST(Bytes, WhatIsWrittenIsRead) {
  std::vector<std::byte> bytes = {std::byte{9}};
  ByteWriter writer(bytes);
  writer.value(-5);
  writer.value(true);
  writer.value(std::numeric_limits<double>::quiet_NaN());
  writer.value(Vec2<float>{1.5f, -0.0f});
  writer.values(std::vector<Filled>{{1.0f, 2}, {3.0f, 4}});
  writer.values(std::vector<double>{});
  writer.text("a name");
  EXPECT_EQ(bytes.size(), 1 + 4 + 1 + 8 + 8 + (8 + 16) + 8 + (8 + 6u));
  EXPECT_EQ(bytes.front(), std::byte{9}) << "appended";

  ByteReader reader(std::span<const std::byte>(bytes).subspan(1));
  EXPECT_EQ(reader.value<int>("n"), -5);
  EXPECT_TRUE(reader.value<bool>("b"));
  EXPECT_TRUE(std::isnan(reader.value<double>("d")));
  const auto vector = reader.value<Vec2<float>>("v");
  EXPECT_EQ(vector.x, 1.5f);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(vector.y), 0x80000000u) << "bits, not values";
  std::vector<Filled> filled = {{9, 9}, {9, 9}, {9, 9}};
  reader.values(filled, "f");
  ASSERT_EQ(filled.size(), 2u);
  EXPECT_EQ(filled[1].mass, 3.0f);
  EXPECT_EQ(filled[1].index, 4);
  std::vector<double> none = {1, 2};
  reader.values(none, "e");
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(reader.text("t"), "a name");
  EXPECT_TRUE(reader.rest().empty());
}

TEST(Bytes, WhatIsCutOffIsRefused) {
  std::vector<std::byte> bytes;
  ByteWriter writer(bytes);
  writer.value(7.0);
  writer.values(std::vector<int>{1, 2, 3});
  writer.text("text");
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto read = [&] {
      ByteReader reader(std::span<const std::byte>(bytes.data(), size));
      reader.value<double>("number");
      std::vector<int> numbers;
      reader.values(numbers, "numbers");
      reader.text("text");
    };
    expect_refused(read, size < 8 ? "number" : size < 28 ? "numbers" : "text");
  }
}

// A count that no memory holds must not be tried, nor overflow when it is multiplied.
TEST(Bytes, CountsAreHeldAgainstWhatIsThere) {
  for (const std::uint64_t count : {std::uint64_t{2}, std::uint64_t{1} << 40, std::uint64_t{1} << 61,
                                    std::numeric_limits<std::uint64_t>::max()}) {
    std::vector<std::byte> bytes;
    ByteWriter writer(bytes);
    writer.value(count);
    writer.value(std::uint64_t{0});
    std::vector<double> numbers;
    expect_refused([&] { ByteReader(bytes).values(numbers, "numbers"); }, "numbers");
    if (count > 8) expect_refused([&] { ByteReader(bytes).text("name"); }, "name");
  }
}

TEST(Bytes, ABoolIsOneOfTwo) {
  const std::vector<std::byte> bytes = {std::byte{2}};
  expect_refused([&] { ByteReader(bytes).value<bool>("awake"); }, "awake");
}

}  // namespace
}  // namespace plumb
