#include "common/config/case_reader.hpp"

#include "common/config/schema.hpp"

#include <fmt/format.h>

namespace kerf::config {
namespace {

using nlohmann::json;
using std::string;

json example_table(const string& table, const string& kind);

/// The text with every line a comment.
string commented(const string& text) {
  string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin) + 1;
    const string line = text.substr(begin, end - begin);
    result += (line.front() == '#' || line.front() == '\n' ? "" : "# ") + line;
    begin = end;
  }
  return result;
}

/// Writes settings in the order of the table of keys, plain or with everything there is to know.
class Writer {
public:
  /// @param participants  of the case, whose kinds changes of stages have
  Writer(bool with_notes, const json& participants)
      : with_notes_(with_notes), participants_(participants) {}

  /// @param table   pattern of the table
  /// @param header  its name in the file: "participants.rock.material"
  void write_table(const string& table, const string& header, const string& kind,
                   const json& values) {
    for (const Key* key : keys_of(table, kind))
      if (!key->is_table())
        write_value(*key, values.at(key->last()));
    for (const Key* key : keys_of(table, kind))
      if (key->is_table())
        write_member(*key, header.empty() ? key->last() : header + "." + key->last(), kind,
                     values.at(key->last()));
  }

  string text;

private:
  void write_value(const Key& key, const json& value) {
    if (!with_notes_) {
      const string unit = key.unit.empty() ? "" : "  # " + key.unit;
      text += value.is_null() ? fmt::format("# {}: not given\n", key.last())
                              : fmt::format("{} = {}{}\n", key.last(), value_text(value), unit);
      return;
    }
    text += fmt::format("# {}\n", key.doc);
    const string line = value.is_null() ? fmt::format("# {} = {}", key.last(), key.example)
                                        : fmt::format("{} = {}", key.last(), value_text(value));
    text += fmt::format("{:<36} # {}\n", line, notes(key));
  }

  /// "m; required; greater than 0".
  static string notes(const Key& key) {
    string standard = "required";
    if (!key.required())
      standard = key.standard == "null" ? "not given by default"
                                        : "default " + value_text(json::parse(key.standard));
    const string allowed = key.allowed.text();
    return (key.unit.empty() ? "" : key.unit + "; ") + standard +
           (allowed.empty() ? "" : "; " + allowed);
  }

  void write_member(const Key& key, const string& header, const string& kind, const json& value) {
    if (key.type == Type::named_tables) {
      for (const auto& [name, member] : value.items()) {
        begin_table(fmt::format("[{}.{}]", header, name), key.doc);
        write_table(inside(key), header + "." + name, member.at("kind"), member);
      }
    } else if (key.type == Type::list) {
      for (const json& member : value) {
        begin_table(fmt::format("[[{}]]", header), key.doc);
        write_table(inside(key), header,
                    key.path == "stages[].changes" ? kind_of_change(member, participants_) : kind,
                    member);
      }
    } else if (!value.is_null()) {
      begin_table(fmt::format("[{}]", header), key.doc);
      write_table(inside(key), header, kind, value);
    } else if (with_notes_) { // the case does without it
      Writer table(true, participants_);
      table.begin_table(fmt::format("[{}]", header), key.doc);
      table.write_table(inside(key), header, kind, example_table(inside(key), kind));
      text += '\n' + commented(table.text);
    }
  }

  void begin_table(const string& line, const string& doc) {
    if (!text.empty())
      text += '\n';
    if (with_notes_)
      text += fmt::format("# {}\n", doc);
    text += line + '\n';
  }

  bool with_notes_;
  const json& participants_;
};

/// Settings made of the examples and defaults of the table of keys.
json example_table(const string& table, const string& kind) {
  json result = json::object();
  for (const Key* key : keys_of(table, kind)) {
    json& value = result[key->last()];
    const bool is_live = key->required() || key->live;
    if (key->type == Type::named_tables)
      value = {{"rock", example_table(inside(*key), "dem")},
               {"far", example_table(inside(*key), "fem")}};
    else if (key->path == "stages[].changes") {
      value = {example_table(inside(*key), "dem"), example_table(inside(*key), "fem")};
      value[1]["participant"] = "far";
    } else if (key->type == Type::list)
      value = json::array({example_table(inside(*key), kind)});
    else if (key->type == Type::table || (key->is_table() && is_live))
      value = example_table(inside(*key), kind);
    else
      value = is_live ? parse_value(key->example) : json::parse(key->standard);
  }
  return result;
}

} // namespace

string settings_toml(const json& settings) {
  Writer writer(false, settings.at("participants"));
  writer.write_table("", "", "", settings);
  return writer.text;
}

string reference_toml() {
  const json example = example_table("", "");
  Writer writer(true, example.at("participants"));
  writer.write_table("", "", "", example);
  return "# Every key that a case may have. After each value: its unit, its default and what is "
         "allowed.\n# Keys that are commented out have no default, and this case does without "
         "them.\n# This file is generated from the table of keys (common/config/schema.cpp); a "
         "test compares both.\n\n" +
         writer.text;
}

} // namespace kerf::config
