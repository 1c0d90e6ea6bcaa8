// history/<participant>_cracks.csv: a row for every bond that broke.
#pragma once

#include "common/history.hpp"
#include "dem_core/crack.hpp"

#include <cstdint>
#include <filesystem>
#include <span>

namespace kerf::dem {

template <int dim> class CrackFile {
public:
  /// @param first_step  of this run
  /// @param before      cracks that are in the file already
  CrackFile(const std::filesystem::path& path, std::uint64_t first_step,
            std::span<const Crack<dim>> before);

  /// Appends the cracks that are not in the file yet, with the ids of their particles.
  /// @param all  every crack since the start
  void write(std::span<const Crack<dim>> all, std::span<const std::uint32_t> ids);

  std::size_t size() const noexcept { return written_; }
  std::size_t tension() const noexcept { return tension_; }
  std::size_t shear() const noexcept { return written_ - tension_; }

private:
  History file_;
  std::size_t written_ = 0, tension_ = 0;
};

} // namespace kerf::dem
