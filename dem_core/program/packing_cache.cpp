#include "dem_core/program/packing_cache.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>

namespace kerf::dem {

namespace {

/// The file repeats the description, so that two with the same fingerprint are told apart.
std::filesystem::path file_of(const std::filesystem::path& cache, const std::string& description) {
  return cache / (fingerprint(description) + ".txt");
}

} // namespace

std::string fingerprint(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text)
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("{:016x}", hash);
}

std::filesystem::path packing_cache() {
  const auto variable = [](const char* name) -> std::filesystem::path {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
  };
  if (const auto cache = variable("XDG_CACHE_HOME"); !cache.empty())
    return cache / "kerf" / "packings";
  const auto home = variable("HOME");
  return home.empty() ? home : home / ".cache" / "kerf" / "packings";
}

std::optional<Packing> find_packing(const std::filesystem::path& cache,
                                    const std::string& description) {
  const std::filesystem::path path = file_of(cache, description);
  std::ifstream file(path);
  std::string first;
  if (!std::getline(file, first) || first != "# " + description)
    return std::nullopt;
  try {
    return read_packing(path);
  } catch (const PackingError&) {
    return std::nullopt;
  }
}

void keep_packing(const std::filesystem::path& cache, const std::string& description,
                  const Packing& packing) {
  write_packing(file_of(cache, description), packing, PackingFormat::text, description);
}

} // namespace kerf::dem
