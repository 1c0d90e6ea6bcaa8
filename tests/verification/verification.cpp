#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

namespace kerf {
namespace {

/// A file of lines of JSON for every test that runs, also for one that verifies nothing: so rows of
/// an earlier run of it do not stay.
class Report : public testing::EmptyTestEventListener {
public:
  Report() {
    if (const char* folder = std::getenv("KERF_VERIFICATION"))
      folder_ = folder;
  }

  void OnTestStart(const testing::TestInfo& test) override {
    if (!folder_)
      return;
    name_ = std::string(test.test_suite_name()) + "." + test.name();
    std::string file = name_;
    std::replace(file.begin(), file.end(), '/', '%'); // of typed tests
    std::filesystem::create_directories(*folder_);
    lines_ = std::ofstream(*folder_ / (file + ".jsonl"));
  }

  void add(const Verification& claim, double error, const std::source_location& where) {
    if (!folder_)
      return;
    const std::string path = where.file_name();
    const nlohmann::json row = {
        {"test", name_},         {"file", path.substr(path.rfind("/tests/") + 1)},
        {"what", claim.what},    {"source", claim.source},
        {"error", error},        {"tolerance", claim.tolerance},
        {"reason", claim.reason}};
    lines_ << row << std::endl;
  }

private:
  std::optional<std::filesystem::path> folder_;
  std::string name_;
  std::ofstream lines_;
};

/// GoogleTest owns it.
Report& report() {
  static Report* const one = [] {
    auto* made = new Report;
    testing::UnitTest::GetInstance()->listeners().Append(made);
    return made;
  }();
  return *one;
}
[[maybe_unused]] const Report& before_main = report();

} // namespace

void verify(const Verification& claim, double error, std::source_location where) {
  const double size = std::abs(error);
  report().add(claim, size, where);
  if (!(size <= claim.tolerance)) // nor when it is not a number
    ADD_FAILURE_AT(where.file_name(), static_cast<int>(where.line()))
        << claim.what << ": error " << error << " exceeds " << claim.tolerance;
}

} // namespace kerf
