// A value of the table of a participant that knows its key.
#pragma once

#include "common/vec.hpp"
#include "coupler/participant/participant.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <string_view>

namespace kerf::dem {

/// Its errors name the key inside the participant's table.
class Node {
public:
  Node(const nlohmann::json& value, std::string key) : value_(&value), key_(std::move(key)) {}

  const std::string& key() const { return key_; }
  std::size_t size() const { return value_->size(); }
  bool is_null() const { return value_->is_null(); }
  [[noreturn]] void fail(const std::string& sentence) const {
    throw coupler::SettingsError(key_, sentence);
  }
  [[noreturn]] void fail(const std::string& sentence, std::string_view fix) const {
    fail(fmt::format("{}\n{}", sentence, fix));
  }

  /// A member; null when it is missing.
  Node operator[](std::string_view name) const {
    static const nlohmann::json missing;
    const auto member = value_->is_object() ? value_->find(name) : value_->end();
    const std::string key = key_.empty() ? std::string(name) : fmt::format("{}.{}", key_, name);
    return {value_->is_object() && member != value_->end() ? *member : missing, key};
  }
  Node operator[](std::size_t index) const {
    return {value_->at(index), fmt::format("{}[{}]", key_, index)};
  }

  double number() const {
    if (!value_->is_number())
      fail(is_null() ? "a number is missing here" : "this must be a number");
    return value_->get<double>();
  }
  double number_or(double other) const { return is_null() ? other : number(); }
  double positive() const {
    const double value = number();
    if (!(value > 0.0))
      fail(fmt::format("{} must be positive", value));
    return value;
  }
  double not_negative_or(double other) const {
    const double value = number_or(other);
    if (!(value >= 0.0))
      fail(fmt::format("{} must not be negative", value));
    return value;
  }
  /// False when it is not given.
  bool flag() const {
    if (!is_null() && !value_->is_boolean())
      fail("this must be true or false");
    return !is_null() && value_->get<bool>();
  }
  double share() const {
    const double value = number_or(0.0);
    if (!(value >= 0.0 && value <= 1.0))
      fail(fmt::format("{} must be from 0 to 1", value));
    return value;
  }
  std::string text() const {
    if (!value_->is_string())
      fail(is_null() ? "a word is missing here" : "this must be a word in quotes");
    return value_->get<std::string>();
  }
  /// The value that a word stands for.
  template <class Value> Value one_of(const std::map<std::string, Value>& words) const {
    const auto found = words.find(text());
    if (found != words.end())
      return found->second;
    std::string allowed;
    for (const auto& [word, value] : words)
      allowed += (allowed.empty() ? "" : ", ") + word;
    fail(fmt::format("\"{}\" must be one of {}", text(), allowed));
  }
  void must_hold(std::size_t count, const char* what) const {
    if (!value_->is_array() || value_->size() != count)
      fail(fmt::format("this must be a list of {} {}", count, what));
  }
  template <int dim> Vec<dim> vector() const {
    must_hold(dim, "numbers");
    Vec<dim> vector;
    for (std::size_t a = 0; a < dim; ++a)
      vector[static_cast<int>(a)] = (*this)[a].number();
    return vector;
  }
  template <int dim> Vec<dim> vector_or_zero() const {
    return is_null() ? Vec<dim>(Vec<dim>::Zero()) : vector<dim>();
  }
  template <int dim> Box<dim> box() const {
    must_hold(2, "corners");
    return {(*this)[0].vector<dim>(), (*this)[1].vector<dim>()};
  }
  template <int dim> int axis() const {
    const std::string word = text();
    const auto axis = std::string("xyz").substr(0, dim).find(word);
    if (word.size() != 1 || axis == std::string::npos)
      fail(fmt::format("\"{}\" is not an axis in {}D", word, dim));
    return static_cast<int>(axis);
  }

private:
  const nlohmann::json* value_;
  std::string key_;
};

} // namespace kerf::dem
