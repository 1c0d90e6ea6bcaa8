// Reads a case by the table of keys: what is there, of the right type, in range; defaults
// elsewhere.
#pragma once

#include "common/config/problems.hpp"

#include <filesystem>

namespace kerf::config {

/// The settings of a case: every key of the table, null where nothing is given.
///
/// @param folder    paths of the case are relative to it
/// @param problems  receives what is wrong; then the settings are incomplete
nlohmann::json read_settings(const Document& document, const std::filesystem::path& folder,
                             Problems& problems);

/// The kind of participant that a change of a stage is for: of the one that it names, or of the
/// only one; "dem" when that cannot be told.
std::string kind_of_change(const nlohmann::json& change, const nlohmann::json& participants);

/// Finds what is wrong with settings that are complete: names of participants that are not there,
/// keys that exclude or need one another, vectors along axes that a plane does not have.
/// Also fills in the kinds of measures that are their names.
void check_settings(nlohmann::json& settings, const Document& document, Problems& problems);

/// The part of check_settings() about the materials of one participant and pairs of them.
/// @param participant  "participants.rock"
void check_materials(const std::string& participant, const nlohmann::json& table,
                     Problems& problems);

/// The part of check_settings() about what the elements of one participant are made of. Also fills
/// in what 2D means where that is not given.
/// @param participant  "participants.far"
void check_solids(const std::string& participant, nlohmann::json& settings, Problems& problems);

/// The part of check_settings() about the mesh of one participant.
/// @param key            "participants.far.mesh"
/// @param case_settings  the table [case]
void check_mesh(const std::string& key, const nlohmann::json& mesh,
                const nlohmann::json& case_settings, Problems& problems);

/// The part of check_settings() about what acts on the elements of one participant.
/// @param participant  "participants.far"
void check_elements(const std::string& participant, const nlohmann::json& settings,
                    Problems& problems);

/// The part of it about a list of loads, of a participant or of a stage.
void check_node_loads(const std::string& list, const nlohmann::json& loads,
                      const nlohmann::json& settings, Problems& problems);

/// The part of check_settings() about stages, stop conditions and the end of the run.
void check_stages(const nlohmann::json& settings, Problems& problems);

/// The settings as TOML, in the order of the table of keys.
std::string settings_toml(const nlohmann::json& settings);

/// configs/reference.toml: every key with its unit, default, range and meaning, as a case that
/// loads. Keys without a default that the case does not need are commented out.
std::string reference_toml();

} // namespace kerf::config
