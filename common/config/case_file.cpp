#include "common/config/case_file.hpp"

#include "common/config/case_reader.hpp"

#include <fstream>
#include <iterator>

namespace kerf {

CaseFile CaseFile::read(const std::filesystem::path& path,
                        const std::vector<std::string>& overrides) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!std::filesystem::is_regular_file(path) || !file.is_open() || file.bad())
    throw ConfigError({path.string(), 0}, "the case file cannot be read.",
                      "give the path of a TOML file, for example configs/wave_bar.toml.");
  return parse(text, path.string(), std::filesystem::absolute(path).parent_path(), overrides);
}

CaseFile CaseFile::parse(std::string_view text, const std::string& name,
                         const std::filesystem::path& folder,
                         const std::vector<std::string>& overrides) {
  config::Document document = config::parse_document(text, name);
  for (const std::string& assignment : overrides)
    config::apply_override(document, assignment);

  CaseFile result;
  config::Problems problems(document);
  result.settings_ = config::read_settings(document, folder, problems);
  problems.throw_if_any();
  config::check_settings(result.settings_, document, problems);
  problems.throw_if_any();
  result.document_ = std::make_shared<const config::Document>(std::move(document));
  return result;
}

Place CaseFile::place_of(std::string_view key) const {
  return document_->place_of(key);
}

ConfigError CaseFile::error(std::string_view key, const std::string& problem,
                            const std::string& fix) const {
  return {place_of(key), problem, fix};
}

std::string CaseFile::to_toml() const {
  return config::settings_toml(settings_);
}

} // namespace kerf
