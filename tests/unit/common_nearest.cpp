// A misspelt word finds the one that was meant, and a strange word finds none.
#include "common/nearest.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

// Distances as counted by hand with insertion, deletion, replacement and a swap of neighbours.
TEST(EditDistance, counts_the_changes_between_two_words) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("densty", "density"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("width", "widht"), 1U);
}

TEST(Nearest, finds_what_was_meant_and_nothing_for_strange_words) {
  const std::vector<std::string> words = {"density", "friction", "radius"};
  EXPECT_EQ(nearest("densty", words), "density");
  EXPECT_EQ(nearest("raduis", words), "radius");
  EXPECT_EQ(nearest("temperature", words), "");
  EXPECT_EQ(nearest("x", words), "");
  EXPECT_EQ(nearest("density", {}), "");
}

} // namespace
} // namespace kerf
