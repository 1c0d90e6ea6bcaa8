// Packings as files: every format keeps every bit, and faults are told with their line.
#include "common/packing_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace kerf {
namespace {

class PackingFiles : public ::testing::Test {
protected:
  PackingFiles() {
    std::string pattern = (std::filesystem::temp_directory_path() / "kerf-packing-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~PackingFiles() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& text) {
    std::ofstream(folder_ / "file") << text;
    return folder_ / "file";
  }
  /// What the reader says of a file, without its folder.
  std::string complaint(const std::string& text, std::optional<int> dim = {}) {
    try {
      read_packing(write(text), dim);
      return "";
    } catch (const PackingError& error) {
      const std::string what = error.what();
      return what.substr(what.find("file"));
    }
  }
  std::filesystem::path folder_;
};

Packing awkward(int dim) {
  Packing packing{.dim = dim, .positions = {}, .radii = {0.1, 1.0 / 3.0, 4.9e-324, 1e300}};
  for (int k = 0; k < 4 * dim; ++k)
    packing.positions.push_back(std::sin(k) * std::pow(10.0, 20 * (k % 3 - 1)));
  return packing;
}

TEST_F(PackingFiles, of_every_format_are_told_apart_and_give_the_same_bits_back) {
  for (const int dim : {2, 3})
    for (const auto format :
         {PackingFormat::text, PackingFormat::yade, PackingFormat::vtk, PackingFormat::dump}) {
      const Packing packing = awkward(dim);
      write_packing(folder_ / "file", packing, format, "a comment");
      const Packing read = read_packing(folder_ / "file");
      EXPECT_EQ(read.dim, dim);
      EXPECT_EQ(read.positions, packing.positions);
      EXPECT_EQ(read.radii, packing.radii);
    }
}

TEST_F(PackingFiles, are_written_in_the_format_of_their_extension) {
  EXPECT_EQ(packing_format("a.vtk"), PackingFormat::vtk);
  EXPECT_EQ(packing_format("a.dump"), PackingFormat::dump);
  EXPECT_EQ(packing_format("a.yade"), PackingFormat::yade);
  EXPECT_EQ(packing_format("a.txt"), PackingFormat::text);
}

// As yade.export.textExt, a LIGGGHTS dump of two moments, and ParaView's unstructured points do.
TEST_F(PackingFiles, of_other_programs_are_read) {
  const Packing yade = read_packing(write("#format x_y_z_r_matId\n1\t2\t3\t0.5\t0\n"));
  EXPECT_EQ(yade.positions, (std::vector<double>{1, 2, 3}));
  const Packing dump = read_packing(write(
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
      "ITEM: ATOMS id type x y z radius\n1 1 9 9 9 9\n"
      "ITEM: TIMESTEP\n10\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
      "ITEM: ATOMS id type radius x y z vx \n2 1 0.2 4 5 6 0\n1 1 0.1 1 2 3 0\n"));
  EXPECT_EQ(dump.radii, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(dump.positions, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  const Packing vtk = read_packing(
      write("# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 float\n"
            "0 0 1 4 5\n6\nCELLS 2 4\n1 0\n1 1\nCELL_TYPES 2\n1\n1\nPOINT_DATA 2\n"
            "SCALARS id int 1\nLOOKUP_TABLE default\n0 1\nSCALARS radius float\n"
            "LOOKUP_TABLE default\n0.5\n0.25\n"));
  EXPECT_EQ(vtk.radii, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(vtk.positions, (std::vector<double>{0, 0, 1, 4, 5, 6}));
}

TEST_F(PackingFiles, with_faults_are_refused_with_the_line) {
  EXPECT_EQ(complaint("0 0 1\n0 0 one\n"), "file:2: \"one\" is not a finite number");
  EXPECT_EQ(complaint("0 0 1\n\n0 0 0 1\n"),
            "file:3: a line must hold 3 values, x y r, but this one holds 4");
  EXPECT_EQ(complaint("0 0 -1\n"), "file:1: the radius -1 m must be positive");
  EXPECT_EQ(complaint("# nothing\n"), "file holds no particle");
  EXPECT_EQ(complaint("0 0 1 1\n#format x_y_z_r\n", 2),
            "file:1: a line must hold 3 values, x y r, but this one holds 4");
  EXPECT_EQ(complaint("#format x_y_z_r\n0 0 1 1\n", 2),
            "file holds particles with z other than zero");
  EXPECT_EQ(complaint("#format x_y_z_r\n0 0 1\n"),
            "file:2: a line must hold 4 values, x y z r, but this one holds 3");
  EXPECT_EQ(complaint("# vtk DataFile Version 3.0\nt\nBINARY\n"),
            "file:3: legacy VTK must be ASCII, not BINARY");
  EXPECT_EQ(complaint("# vtk DataFile Version 3.0\nt\nASCII\nPOINTS 1 double\n0 0 0\n"),
            "file:5: the points have no scalar \"radius\"");
  EXPECT_EQ(
      complaint("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS id x y z\n1 0 0 0\n"),
      "file:5: the atoms have no column \"radius\"");
  EXPECT_EQ(complaint("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS id x y z radius\n"
                      "1 0 0 0 1\n"),
            "file ends where an atom should follow");
}

} // namespace
} // namespace kerf
