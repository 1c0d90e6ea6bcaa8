// Lines of the log say when, who and what.
#include "common/log.hpp"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

namespace kerf {
namespace {

TEST(Log, has_time_name_and_text_and_is_in_the_file_at_once) {
  const auto path = std::filesystem::temp_directory_path() / "kerf_log" / "rock.log";
  start_log({.name = "rock", .file = path, .to_stderr = false});
  spdlog::info("step {}", 3);
  spdlog::warn("the disk is nearly full");
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string time = R"(\[\d\d:\d\d:\d\d\.\d\d\d\])";
  EXPECT_TRUE(std::regex_match(text, std::regex(time + " rock: step 3\n" + time +
                                                " rock: warning: the disk is nearly full\n")))
      << text;
  start_log({.name = "kerf", .file = {}, .to_stderr = true});
  std::filesystem::remove_all(path.parent_path());
}

} // namespace
} // namespace kerf
