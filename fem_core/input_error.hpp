// What is thrown when the settings of a finite element body cannot be used.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace kerf::fem {

/// The text says what is wrong and what to write instead; the key says where.
class InputError : public std::invalid_argument {
public:
  /// @param key  path inside the settings of the body, for example "boundary[0].tag"
  InputError(std::string key, const std::string& sentence)
      : std::invalid_argument(sentence), key_(std::move(key)) {}
  const std::string& key() const noexcept { return key_; }

private:
  std::string key_;
};

} // namespace kerf::fem
