#include "engine/scene/error.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

using Kind = Error::Kind;

TEST(Error, IsOneSentence) {
  const Error error(Kind::Value, "body 'ball'", "mass", "-1", "must be a positive number of kg", 12);
  EXPECT_STREQ(error.what(), "line 12: body 'ball': mass is -1: must be a positive number of kg");
  EXPECT_EQ(error.kind(), Kind::Value);
  EXPECT_EQ(error.subject(), "body 'ball'");
  EXPECT_EQ(error.field(), "mass");
  EXPECT_EQ(error.value(), "-1");
  EXPECT_EQ(error.problem(), "must be a positive number of kg");
  EXPECT_EQ(error.line(), 12);
}

TEST(Error, EmptyPartsLeaveNoTrace) {
  EXPECT_STREQ(Error(Kind::Value, "", "dt", "0", "must be positive").what(), "dt is 0: must be positive");
  EXPECT_STREQ(Error(Kind::Value, "body 3", "name", "", "must not be empty").what(),
               "body 3: name: must not be empty");
  EXPECT_STREQ(Error(Kind::Syntax, "scene", "", "5", "must be an object").what(),
               "scene: 5: must be an object");
  EXPECT_STREQ(Error(Kind::Io, "", "", "", "no such file").what(), "no such file");
  EXPECT_STREQ(Error(Kind::Run, "body 'a'", "", "", "").what(), "body 'a': the run could not go on");
  EXPECT_STREQ(Error(Kind::Name, "", "", "", "").what(), "unacceptable name");
}

TEST(Error, QuotesNamesOnce) {
  EXPECT_STREQ(Error(Kind::Name, "joint 'rod'", "body_a", "bal", "must be a body").what(),
               "joint 'rod': body_a is 'bal': must be a body");
  EXPECT_STREQ(Error(Kind::Name, "scenario", "", "free_fal", "is not known").what(),
               "scenario 'free_fal': is not known");
  EXPECT_STREQ(Error(Kind::Name, "scenario", "", "'free_fal'", "is not known").what(),
               "scenario 'free_fal': is not known");
}

TEST(Error, MovesToALine) {
  const Error error = Error(Kind::Name, "body 'a'", "name", "a", "must be unique").at_line(7);
  EXPECT_EQ(error.line(), 7);
  EXPECT_EQ(error.kind(), Kind::Name);
  EXPECT_STREQ(error.what(), "line 7: body 'a': name is 'a': must be unique");
}

}  // namespace
}  // namespace plumb
