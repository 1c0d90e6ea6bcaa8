#include "common/config/document.hpp"

#include "common/nearest.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <vector>

namespace kerf::config {
namespace {

using nlohmann::json;

/// Copies a node and notes where it and all its members stand.
json convert(const toml::node& node, const std::string& key, Document& document) {
  if (!key.empty())
    document.places[key] = {document.source, static_cast<int>(node.source().begin.line)};
  if (const toml::table* table = node.as_table()) {
    json values = json::object();
    for (const auto& [name, member] : *table) {
      const std::string text(name.str());
      values[text] = convert(member, key.empty() ? text : key + "." + text, document);
    }
    return values;
  }
  if (const toml::array* array = node.as_array()) {
    json values = json::array();
    for (const toml::node& member : *array)
      values.push_back(convert(member, fmt::format("{}[{}]", key, values.size()), document));
    return values;
  }
  if (const auto* value = node.as_boolean())
    return value->get();
  if (const auto* value = node.as_integer())
    return value->get();
  if (const auto* value = node.as_floating_point())
    return value->get();
  if (const auto* value = node.as_string())
    return value->get();
  std::ostringstream date;
  node.visit([&](const auto& value) { date << value; });
  return date.str();
}

/// The parser's complaint as a sentence of ours where a beginner meets it.
ConfigError syntax_error(const toml::parse_error& error, const std::string& source) {
  const Place place{source, static_cast<int>(error.source().begin.line)};
  const std::string text(error.description());
  if (const std::size_t at = text.find("redefine"); at != std::string::npos) {
    const std::size_t open = text.find('\'', at), close = text.find('\'', open + 1);
    const std::string key =
        close == std::string::npos ? "a key" : text.substr(open + 1, close - open - 1);
    const std::string parent = "participants.";
    if (key.starts_with(parent) && key.find('.', parent.size()) == std::string::npos)
      return {place, fmt::format("two participants are named \"{}\".", key.substr(parent.size())),
              "give each participant a name of its own."};
    return {place, key + " is given twice.", "keep one of the two."};
  }
  return {place, "this is not TOML: " + text + ".",
          "write key = value, with text in quotes and tables as [name]."};
}

/// "couplings[0].width" as couplings, [0], width.
std::vector<std::string> steps_of(std::string_view key) {
  std::vector<std::string> steps(1);
  for (const char c : key) {
    if (c == '.' || c == '[')
      steps.emplace_back();
    if (c != '.')
      steps.back() += c;
  }
  return steps;
}

/// The index of a member by "[3]" or by its name; the size of the list when there is none.
std::size_t find_member(const json& list, const std::string& step) {
  if (step.starts_with('[') && step.size() > 2 && step.ends_with(']') &&
      step.find_first_not_of("0123456789", 1) == step.size() - 1 && step.size() < 12)
    return std::min<std::size_t>(std::stoul(step.substr(1)), list.size());
  std::size_t index = 0;
  while (index < list.size() &&
         !(list[index].is_object() && list[index].value("name", json()) == step))
    ++index;
  return index;
}

std::vector<std::string> member_names(const json& list) {
  std::vector<std::string> names;
  for (const json& member : list)
    if (member.is_object() && member.contains("name") && member["name"].is_string())
      names.push_back(member["name"]);
  return names;
}

std::string number_text(double number) {
  char digits[32];
  std::string text(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
  if (const std::size_t e = text.find('e'); e != std::string::npos) { // 1e+09 as 1e9
    const std::size_t zeros = text[e + 1] == '+' ? e + 1 : e + 2;
    text.erase(zeros, text.find_first_not_of("+0", zeros) - zeros);
  } else if (text.find_first_not_of("-0123456789") == std::string::npos) {
    text += ".0";
  }
  return text;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      result += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      result += c;
  }
  return result + "\"";
}

} // namespace

Place Document::place_of(std::string_view key) const {
  std::string around = canonical_key(values, key);
  while (true) {
    if (const auto found = places.find(around); found != places.end())
      return found->second;
    const std::size_t end = around.find_last_of(".[");
    if (end == std::string::npos)
      return {source, 0};
    around.erase(end);
  }
}

Document parse_document(std::string_view text, const std::string& source) {
  Document document;
  document.source = source;
  try {
    document.values = convert(toml::parse(text, source), "", document);
  } catch (const toml::parse_error& error) {
    throw syntax_error(error, source);
  }
  return document;
}

json parse_value(std::string_view text) {
  const json values = parse_document(fmt::format("value = {}", text), "value").values;
  if (values.size() != 1)
    throw ConfigError({"value", 0}, "this is more than one value.", "give one value.");
  return values.at("value");
}

void apply_override(Document& document, const std::string& assignment) {
  const Place place{"--set " + assignment, 0};
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ConfigError(place, "this has no key and value.",
                      "write key=value, for example case.seed=2.");
  const std::string key = assignment.substr(0, equals), text = assignment.substr(equals + 1);

  json* node = &document.values;
  std::string reached;
  for (const std::string& step : steps_of(key)) {
    if (node->is_array()) {
      const std::size_t index = find_member(*node, step);
      if (index == node->size()) {
        const std::string meant = nearest(step, member_names(*node));
        throw ConfigError(place, fmt::format("{} has no member {}.", reached, step),
                          meant.empty() ? fmt::format("name one of its {} members, or give its "
                                                      "index from 0, as {}[0].",
                                                      node->size(), reached)
                                        : "did you mean " + meant + "?");
      }
      node = &(*node)[index];
      reached += fmt::format("[{}]", index);
    } else if (node->is_object() && !step.empty() && !step.starts_with('[')) {
      reached += (reached.empty() ? "" : ".") + step;
      node = &(*node)[step];
      if (node->is_null()) { // was not there
        *node = json::object();
        document.places[reached] = place;
      }
    } else {
      throw ConfigError(place, fmt::format("{} has no member {}.", reached, step),
                        "give the key with dots between its parts, as case.end_time.");
    }
  }
  try {
    *node = parse_value(text);
  } catch (const ConfigError&) {
    *node = text;
  }
  std::erase_if(document.places, [&](const auto& entry) {
    return entry.first.starts_with(reached + ".") || entry.first.starts_with(reached + "[");
  });
  document.places[reached] = place;
}

std::string canonical_key(const json& values, std::string_view key) {
  const json* node = &values;
  std::string result;
  for (const std::string& step : steps_of(key)) {
    std::string text = step;
    if (node != nullptr && node->is_array()) {
      const std::size_t index = find_member(*node, step);
      node = index < node->size() ? &(*node)[index] : nullptr;
      if (node != nullptr)
        text = fmt::format("[{}]", index);
    } else {
      node =
          node != nullptr && node->is_object() && node->contains(step) ? &(*node)[step] : nullptr;
    }
    result += (result.empty() || text.starts_with('[') ? "" : ".") + text;
  }
  return result;
}

std::string value_text(const json& value) {
  if (value.is_number_float())
    return number_text(value.get<double>());
  if (value.is_string())
    return quoted(value.get<std::string>());
  std::string text;
  if (value.is_array()) {
    for (const json& member : value)
      text += (text.empty() ? "" : ", ") + value_text(member);
    return "[" + text + "]";
  }
  if (value.is_object()) {
    for (const auto& [name, member] : value.items())
      text += (text.empty() ? "" : ", ") + name + " = " + value_text(member);
    return "{" + text + "}";
  }
  return value.dump();
}

} // namespace kerf::config
