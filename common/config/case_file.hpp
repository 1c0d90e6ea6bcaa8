// A case as the user wrote it, checked, with every default filled in.
#pragma once

#include "common/config/config_error.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

namespace config {
struct Document;
}

/// A checked case.
///
///     const CaseFile run = CaseFile::read("configs/wave_bar.toml", {"case.transport=zmq"});
///     const double end = run.settings()["case"]["end_time"]; // s
///
/// Keys are written with dots; members of lists are named by index, or by their key `name`:
/// "participants.rock.boundary[0].box", "couplings[0].width", "couplings.joint.width".
class CaseFile {
public:
  /// Reads and checks everything that can be known without building the geometry.
  ///
  /// @param path       TOML; paths inside it are relative to its folder
  /// @param overrides  "key=value"; the value is TOML, or else taken as text
  /// @throws ConfigError with up to ten problems
  static CaseFile read(const std::filesystem::path& path,
                       const std::vector<std::string>& overrides = {});

  /// The same for text that is in memory.
  /// @param name    stands for the file in errors
  /// @param folder  paths inside the case are relative to it
  static CaseFile parse(std::string_view text, const std::string& name,
                        const std::filesystem::path& folder,
                        const std::vector<std::string>& overrides = {});

  /// {"case": {…}, "participants": {name: {…}}, "couplings": […], "measures": […]} with every
  /// default written out; null where nothing was given and there is no default. Numbers are in
  /// SI units; paths are full paths.
  const nlohmann::json& settings() const { return settings_; }

  /// Where a key stands; where the nearest table around it begins when it is not written out.
  Place place_of(std::string_view key) const;

  /// The error of a fault that was found later, for example by a participant.
  ConfigError error(std::string_view key, const std::string& problem, const std::string& fix) const;

  /// The case as run: TOML with every default written out, that reads back to the same settings.
  std::string to_toml() const;

private:
  CaseFile() = default;

  nlohmann::json settings_;
  std::shared_ptr<const config::Document> document_; // what was written, and where
};

} // namespace kerf
