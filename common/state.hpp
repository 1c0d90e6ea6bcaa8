// The state of an engine as named arrays: what a checkpoint keeps and gives back.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace kerf {

using StateArray = std::variant<std::vector<double>, std::vector<std::uint64_t>,
                                std::vector<std::uint32_t>, std::vector<std::uint8_t>>;
/// "particles.velocity" -> its numbers. Lists have their sizes beside them: "cracks.size".
using State = std::map<std::string, StateArray>;

/// An engine lists its parts once, for both ways:
///
///     template <class Visit> void visit_parts(Skin& skin, Visit& visit) {
///       auto& [width, bound, displacement] = skin; // a member that is not listed does not compile
///       visit("bound", bound);
///       visit("displacement", displacement);
///     }
///
/// A part is a number, an enumeration, a small vector of Eigen, a std::vector or std::array of
/// parts, or anything that has a visit_parts() in its own namespace. Numbers of one name stand one
/// behind the other, so that a list of things becomes one array for each of their parts.
template <class Visitor> class StateVisitor {
public:
  template <class Part> void operator()(std::string_view name, Part& part) {
    const std::string before = path_;
    path_ += (path_.empty() ? "" : ".") + std::string(name);
    visit(part);
    path_ = before;
  }

protected:
  std::string path_;

private:
  template <class T> struct IsList : std::false_type {};
  template <class T> struct IsList<std::vector<T>> : std::true_type {};
  template <class T> struct IsArray : std::false_type {};
  template <class T, std::size_t n> struct IsArray<std::array<T, n>> : std::true_type {};
  template <class T> static constexpr bool is_number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

  template <class Part> void visit(Part& part) {
    auto& self = static_cast<Visitor&>(*this);
    if constexpr (is_number<Part>) {
      self.numbers(&part, 1);
    } else if constexpr (requires { Part::SizeAtCompileTime; }) {
      self.numbers(part.data(), static_cast<std::size_t>(Part::SizeAtCompileTime));
    } else if constexpr (IsList<Part>::value) {
      using Item = typename Part::value_type;
      std::uint64_t size = part.size();
      (*this)("size", size);
      self.resize(part, size);
      if constexpr (is_number<Item>)
        self.numbers(part.data(), part.size());
      else
        for (Item& item : part)
          visit(item);
    } else if constexpr (IsArray<Part>::value) {
      for (std::size_t k = 0; k < part.size(); ++k)
        (*this)(std::to_string(k), part[k]);
    } else {
      visit_parts(part, *this);
    }
  }
};

/// How a number is kept.
template <class Number> struct StoredAs {
  using type = std::conditional_t<
      std::is_same_v<Number, double>, double,
      std::conditional_t<sizeof(Number) == 8, std::uint64_t,
                         std::conditional_t<sizeof(Number) == 4, std::uint32_t, std::uint8_t>>>;
  static_assert(sizeof(type) == sizeof(Number));
};

/// Appends what it visits to a state.
class StateWriter : public StateVisitor<StateWriter> {
public:
  explicit StateWriter(State& state) : state_(state) {}

private:
  friend StateVisitor<StateWriter>;

  template <class Number> void numbers(const Number* first, std::size_t count) {
    using Stored = typename StoredAs<Number>::type;
    if (array_ == nullptr || path_ != path_of_array_) {
      array_ = &state_.try_emplace(path_, std::vector<Stored>()).first->second;
      path_of_array_ = path_;
    }
    auto& stored = std::get<std::vector<Stored>>(*array_);
    for (std::size_t k = 0; k < count; ++k)
      stored.push_back(static_cast<Stored>(first[k]));
  }
  template <class Item> void resize(std::vector<Item>&, std::size_t) {}

  State& state_;
  StateArray* array_ = nullptr; // the last one: the next part of a list has the same
  std::string path_of_array_;
};

/// Sets what it visits to the numbers of a state.
class StateReader : public StateVisitor<StateReader> {
public:
  explicit StateReader(const State& state) : state_(state) {}

  /// @throws std::invalid_argument when something of the state was not asked for
  void finish() const {
    for (const auto& [name, array] : state_) {
      const auto taken = taken_.find(name);
      const std::size_t size = std::visit([](const auto& stored) { return stored.size(); }, array);
      if ((taken == taken_.end() ? 0 : taken->second) != size)
        throw std::invalid_argument("\"" + name + "\" is longer than it should be");
    }
  }

private:
  friend StateVisitor<StateReader>;

  /// @throws std::invalid_argument when the state has no such numbers
  template <class Number> void numbers(Number* first, std::size_t count) {
    using Stored = typename StoredAs<Number>::type;
    if (array_ == nullptr || path_ != path_of_array_) {
      const auto found = state_.find(path_);
      array_ = found == state_.end() ? nullptr : &found->second;
      path_of_array_ = path_;
      if (array_ != nullptr)
        array_taken_ = &taken_[path_];
    }
    const auto* stored = std::get_if<std::vector<Stored>>(array_);
    if (stored == nullptr && count == 0)
      return;
    if (stored == nullptr)
      throw std::invalid_argument("there is no \"" + path_ + "\"");
    std::size_t& taken = *array_taken_;
    if (stored->size() - taken < count)
      throw std::invalid_argument("\"" + path_ + "\" is shorter than it should be");
    for (std::size_t k = 0; k < count; ++k)
      first[k] = static_cast<Number>((*stored)[taken + k]);
    taken += count;
  }
  template <class Item> void resize(std::vector<Item>& list, std::size_t size) {
    constexpr std::size_t most = std::size_t{1} << 36; // what no machine has
    if (size > most)
      throw std::invalid_argument("\"" + path_ + "\" has an absurd size");
    if constexpr (std::default_initializable<Item>)
      list.resize(size);
    else if (list.size() != size) // things that the settings make
      throw std::invalid_argument("\"" + path_ + "\" is not the number that there are");
  }

  const State& state_;
  std::map<std::string, std::size_t> taken_; // of each array
  const StateArray* array_ = nullptr;        // the last one: the next part of a list has the same
  std::size_t* array_taken_ = nullptr;
  std::string path_of_array_;
};

} // namespace kerf
