#include "common/config/case_reader.hpp"

#include "common/config/value_types.hpp"
#include "common/nearest.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kerf::config {
namespace {

using nlohmann::json;
using std::string;

class Reader {
public:
  Reader(const Document& document, std::filesystem::path folder, Problems& problems)
      : document_(document), folder_(std::move(folder)), problems_(problems) {
    const json& values = document.values;
    const json dimension = values.contains("case") && values["case"].is_object()
                               ? values["case"].value("dimension", json())
                               : json();
    if (dimension == 2 || dimension == 3)
      dimension_ = dimension.get<std::size_t>();
  }

  /// @param table    pattern of the table, for the table of keys
  /// @param given    null when the user did not write the table
  /// @param label    what an error calls the table
  json read_table(const string& table, const string& key, const string& kind, const json* given,
                  const string& label) {
    json result = json::object();
    std::vector<string> allowed;
    for (const Key* entry : keys_of(table, kind)) {
      const string name = entry->last();
      allowed.push_back(name);
      const bool is_given = given != nullptr && given->contains(name);
      const string full = key.empty() ? name : key + "." + name;
      result[name] = is_given ? read_value(*entry, full, kind, given->at(name))
                              : read_nothing(*entry, full, kind);
    }
    if (given != nullptr)
      for (const auto& [name, value] : given->items())
        if (std::find(allowed.begin(), allowed.end(), name) == allowed.end())
          report_unknown(key.empty() ? name : key + "." + name, name, label, allowed);
    return result;
  }

private:
  json read_nothing(const Key& entry, const string& key, const string& kind) {
    if (entry.required()) {
      problems_.add(key, key + " is missing.", fix(entry));
      return nullptr;
    }
    return entry.type == Type::table
               ? read_table(inside(entry), key, kind, nullptr, label(entry, key))
               : json::parse(entry.standard);
  }

  json read_value(const Key& entry, const string& key, const string& kind, const json& value) {
    if (!has_type(value, entry.type, dimension_)) {
      problems_.add(key,
                    fmt::format("{} = {} is {}; it must be {}.", key, shown(value), type_of(value),
                                wanted(entry.type, dimension_)),
                    fix(entry));
      return nullptr;
    }
    if (entry.type == Type::named_tables)
      return read_participants(key, value);
    if (entry.type == Type::list) {
      json members = json::array();
      for (const json& member : value)
        members.push_back(
            read_table(inside(entry), fmt::format("{}[{}]", key, members.size()),
                       entry.path == "stages[].changes"
                           ? kind_of_change(member, document_.values.value("participants", json()))
                           : kind,
                       &member, label(entry, key)));
      return members;
    }
    if (entry.is_table())
      return read_table(inside(entry), key, kind, &value, label(entry, key));
    return read_scalars(entry, key, value);
  }

  json read_scalars(const Key& entry, const string& key, const json& value) {
    bool is_good = true;
    for_each_scalar(value, [&](const json& scalar) {
      if (is_good)
        is_good = check_scalar(entry, key, value, scalar);
    });
    if (!is_good)
      return nullptr;
    if (entry.type == Type::path)
      return read_path(entry, key, value);
    const bool has_integers = entry.type == Type::integer || entry.type == Type::counts ||
                              entry.type == Type::integer_or_auto;
    return has_integers ? value : as_reals(value);
  }

  bool check_scalar(const Key& entry, const string& key, const json& value, const json& scalar) {
    const string subject = value.is_array()
                               ? fmt::format("{} in {} = {}", shown(scalar), key, shown(value))
                               : fmt::format("{} = {}", key, shown(value));
    const std::vector<string>& choices = entry.allowed.choices;
    const string text = scalar.is_string() ? scalar.get<string>() : value_text(scalar);
    string must;
    if (!choices.empty() && std::find(choices.begin(), choices.end(), text) == choices.end())
      must = entry.allowed.text();
    else if (scalar.is_number() && !std::isfinite(scalar.get<double>()))
      must = "a finite number";
    else if (scalar.is_number() && choices.empty() &&
             !entry.allowed.range.has(scalar.get<double>()))
      must = entry.allowed.range.text();
    else if (entry.type == Type::name && !is_name(text))
      must = "made of letters, digits, _ and -";
    else if (scalar.is_string() && text.empty())
      must = "something, not nothing";
    if (must.empty())
      return true;
    const string meant = nearest(text, choices);
    problems_.add(key, subject + " must be " + must + ".",
                  meant.empty() ? fix(entry) : "did you mean " + meant + "?");
    return false;
  }

  json read_path(const Key& entry, const string& key, const json& value) {
    const auto path = std::filesystem::absolute(folder_ / value.get<string>()).lexically_normal();
    std::error_code none;
    if (std::filesystem::is_regular_file(path, none))
      return path.string();
    problems_.add(key,
                  fmt::format("{} = {}: there is no file {}.", key, shown(value), path.string()),
                  fix(entry) + " A path is relative to the folder of the case.");
    return nullptr;
  }

  json read_participants(const string& key, const json& value) {
    json participants = json::object();
    for (const auto& [name, given] : value.items()) {
      const string full = key + "." + name;
      if (!is_name(name))
        problems_.add(full,
                      fmt::format("the name of participant \"{}\" must be made of letters, "
                                  "digits, _ and -.",
                                  name),
                      "give it a name that can be part of a file name, for example rock.");
      else if (!given.is_object())
        problems_.add(full, fmt::format("{} = {} is not a participant.", full, shown(given)),
                      fmt::format("begin a table [{}].", full));
      else
        participants[name] = read_participant(full, given);
    }
    if (value.empty())
      problems_.add(key, "the case has no participant.", "begin a table, as [participants.rock].");
    return participants;
  }

  json read_participant(const string& key, const json& given) {
    const Key& kind_entry = *keys_of("participants.*", "dem").front();
    const json kind = given.contains("kind")
                          ? read_value(kind_entry, key + ".kind", "", given["kind"])
                          : read_nothing(kind_entry, key + ".kind", "");
    if (kind.is_null()) // what else it may have depends on it
      return nullptr;
    return read_table("participants.*", key, kind, &given,
                      kind == "dem" ? "a DEM participant" : "an FEM participant");
  }

  void report_unknown(const string& key, const string& name, const string& label,
                      const std::vector<string>& allowed) {
    const string meant = nearest(name, allowed);
    problems_.add(key, fmt::format("{} is not a key of {}.", key, label),
                  fmt::format("{}Allowed: {}.", meant.empty() ? "" : "did you mean " + meant + "? ",
                              fmt::join(allowed, ", ")));
  }

  /// "a DEM material", "a coupling", "[case.output]".
  static string label(const Key& entry, const string& key) {
    if (key.starts_with("case"))
      return "[" + key + "]";
    const string prefix = entry.kind == "dem" ? "a DEM " : "an FEM ";
    if (!entry.kind.empty())
      return prefix + entry.example;
    return (entry.example.front() == 'e' ? "an " : "a ") + entry.example;
  }

  /// What to write instead.
  static string fix(const Key& entry) {
    if (entry.type == Type::named_tables)
      return fmt::format("give {}, for example [participants.rock].", entry.doc);
    if (entry.is_table())
      return fmt::format("give {}, in [{}] or [[{}]].", entry.doc, entry.path, entry.path);
    return fmt::format("give {}, for example {}.", entry.doc, entry.example);
  }

  const Document& document_;
  std::filesystem::path folder_;
  Problems& problems_;
  std::size_t dimension_ = 0; // 0: not known, then vectors of any length pass
};

} // namespace

string kind_of_change(const json& change, const json& participants) {
  const json name = change.value("participant", json());
  if (participants.is_object())
    for (const auto& [other, participant] : participants.items())
      if ((name == other || (name.is_null() && participants.size() == 1)) &&
          participant.is_object() && participant.value("kind", json()) == "fem")
        return "fem";
  return "dem";
}

json read_settings(const Document& document, const std::filesystem::path& folder,
                   Problems& problems) {
  return Reader(document, folder, problems).read_table("", "", "", &document.values, "a case");
}

} // namespace kerf::config
