// Packings that were made before, kept in the user's cache.
#pragma once

#include "common/packing_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::dem {

/// ${XDG_CACHE_HOME:-~/.cache}/kerf/packings; empty without a home.
std::filesystem::path packing_cache();

/// 16 digits that stand for a text: FNV-1a.
std::string fingerprint(std::string_view text);

/// The packing that was kept for a description of everything that decides it. A file that cannot be
/// read counts as none.
std::optional<Packing> find_packing(const std::filesystem::path& cache,
                                    const std::string& description);

/// Keeps a packing, in one step. @throws std::runtime_error when the folder cannot be written
void keep_packing(const std::filesystem::path& cache, const std::string& description,
                  const Packing& packing);

} // namespace kerf::dem
