// Each kind of mesh wants its own keys and no others.
#include "tests/config/sample_case.hpp"

namespace kerf {
namespace {

/// The sample with another mesh.
std::string with_mesh(const std::string& keys) {
  return sample_with("origin = [0.005, 0.0]\nsize = [0.02, 0.003]\ncount = [20, 3]\n", keys);
}

/// "problem\n  Fix: fix" of the only fault.
std::string told(const std::string& keys, const std::vector<std::string>& overrides = {}) {
  const std::string text = complaint(with_mesh(keys), overrides);
  const std::size_t at = text.find("participants.far.mesh");
  return at == std::string::npos ? text : text.substr(at);
}

TEST(BrokenMesh, every_kind_is_taken_with_the_keys_that_it_needs) {
  for (const char* keys :
       {"origin = [0.0, 0.0]\nsize = [1.0, 1.0]\ncount = [2, 2]\ngrading = [2.0, 1.0]",
        "type = \"bar\"\norigin = [0.0, 0.0]\nsize = [1.0, 0.1]\nelements = 10\nshape = \"tri3\"",
        "type = \"disc\"\ncenter = [0.0, 0.0]\nradius = 1.0\ncount = [2, 8]",
        "type = \"ring\"\ncenter = [0.0, 0.0]\nradius = 1.0\ninner_radius = 0.5\ncount = [2, 8]\n"
        "radial_grading = 2.0",
        "type = \"tunnel\"\norigin = [0.0, 0.0]\nsize = [9.0, 9.0]\nradius = 1.0\ncount = [2, 8]\n"
        "excavation = true",
        // any file that exists: the program reads it later
        "type = \"file\"\nfile = \"/proc/self/status\"\nscale = 1e-3\nelement_size = 1e-3"})
    EXPECT_EQ(told(keys + std::string("\n")).find("participants"), std::string::npos) << told(keys);
}

TEST(BrokenMesh, a_missing_key_is_told_with_all_that_the_kind_needs) {
  EXPECT_EQ(told("origin = [0.0, 0.0]\nsize = [1.0, 1.0]\n"),
            "participants.far.mesh.count is missing.\n"
            "  Fix: type = \"box\" needs origin, size, count.");
  EXPECT_EQ(told("type = \"file\"\n"), "participants.far.mesh.file is missing.\n"
                                       "  Fix: type = \"file\" needs file.");
}

TEST(BrokenMesh, a_key_of_another_kind_is_told_with_the_kinds_that_use_it) {
  EXPECT_EQ(told("type = \"disc\"\ncenter = [0.0, 0.0]\nradius = 1.0\ncount = [2, 8]\n"
                 "radial_grading = 2.0\n"),
            "participants.far.mesh.radial_grading is given, but type = \"disc\" does not use it.\n"
            "  Fix: leave it out; it is for ring, tunnel.");
  EXPECT_EQ(told("type = \"ring\"\ncenter = [0.0, 0.0]\nradius = 1.0\ninner_radius = 0.5\n"
                 "count = [2, 8]\nlength = 1.0\n"),
            "participants.far.mesh.length is given, but type = \"ring\" does not use it.\n"
            "  Fix: leave it out; it is for cylinder.");
}

TEST(BrokenMesh, a_kind_or_a_shape_of_another_dimension_is_told) {
  EXPECT_EQ(told("type = \"cylinder\"\n"),
            "participants.far.mesh.type = \"cylinder\" is not of case.dimension = 2.\n"
            "  Fix: give disc, or ring.");
  EXPECT_EQ(told("origin = [0.0, 0.0]\nsize = [1.0, 1.0]\ncount = [2, 2]\nshape = \"tet4\"\n"),
            "participants.far.mesh.shape = \"tet4\" is not of case.dimension = 2.\n"
            "  Fix: give quad4 or tri3.");
}

TEST(BrokenMesh, only_boxes_and_bars_can_be_periodic) {
  EXPECT_EQ(
      told("type = \"disc\"\ncenter = [0.0, 0.0]\nradius = 1.0\ncount = [2, 8]\n",
           {"case.periodic.y=[0.0, 1.0]"}),
      "participants.far.mesh.type = \"disc\" cannot repeat itself along the periodic axis y.\n"
      "  Fix: give a box, or leave out case.periodic.y.");
}

} // namespace
} // namespace kerf
