#include "common/surface_file.hpp"

#include "common/nearest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

namespace kerf {

namespace {

/// Reads the sections of a mesh one after the other. Format: Gmsh reference manual, "MSH file
/// format", versions 4.1 and 2.2 (legacy).
template <int dim> class GmshReader {
public:
  GmshReader(const std::filesystem::path& path, std::string_view physical_name)
      : path_(path), file_(path, '\0'), physical_name_(physical_name) {}

  Surface<dim> read() {
    while (file_.next()) {
      const std::string section(file_.first());
      if (!section.starts_with('$'))
        file_.fail(fmt::format("\"{}\" is found where a section must begin with $", section));
      if (version_ == 0.0 && section != "$MeshFormat")
        file_.fail(fmt::format("{} is found where $MeshFormat is expected", section));
      if (section == "$MeshFormat")
        read_format();
      else if (section == "$PhysicalNames")
        read_physical_names();
      else if (section == "$Entities")
        read_entities();
      else if (section == "$Nodes")
        version_ < 4.0 ? read_nodes_2() : read_nodes_4();
      else if (section == "$Elements")
        version_ < 4.0 ? read_elements_2() : read_elements_4();
      else
        while (!file_.first().starts_with("$End"))
          next();
      if (!file_.first().starts_with("$End"))
        next();
      if (file_.first() != "$End" + section.substr(1))
        file_.fail(fmt::format("\"{}\" is found where $End{} is expected", file_.first(),
                               section.substr(1)));
    }
    if (surface_.facets.empty())
      throw FileError(fmt::format(
          "{} holds no {}{}", path_.string(), dim == 2 ? "line elements" : "triangles",
          physical_name_.empty() ? std::string()
                                 : fmt::format(" in the group \"{}\"", physical_name_)));
    return finish_surface(path_, surface_, line_);
  }

private:
  static constexpr int facet_dim = dim - 1;

  void next() {
    if (!file_.next())
      file_.fail("the file ends inside a section");
  }

  void read_format() {
    next();
    version_ = file_.number(0);
    if (version_ != 2.2 && version_ != 4.1)
      file_.fail(fmt::format("the format is {}, but must be 2.2 or 4.1: save it with gmsh -format "
                             "msh41",
                             file_.words().front()));
    if (file_.count(1) != 0)
      file_.fail("the mesh is binary, but must be ASCII: save it without -bin");
  }

  void read_physical_names() {
    next();
    for (std::uint64_t n = file_.count(0); n > 0; --n) {
      next();
      const auto begin = file_.line().find('"'), end = file_.line().rfind('"');
      if (begin == end)
        file_.fail("a name must stand between quotation marks");
      if (file_.count(0) == facet_dim)
        tag_of_name_[file_.line().substr(begin + 1, end - begin - 1)] = file_.count(1);
    }
  }

  /// Keeps the physical groups of the entities whose elements are facets.
  void read_entities() {
    next();
    const std::array counts = {file_.count(0), file_.count(1), file_.count(2), file_.count(3)};
    for (int entity_dim = 0; entity_dim < 4; ++entity_dim)
      for (std::uint64_t n = counts[static_cast<std::size_t>(entity_dim)]; n > 0; --n) {
        next();
        if (entity_dim != facet_dim)
          continue;
        constexpr std::size_t groups = 7; // behind the tag and the corners of its box
        auto& tags = groups_of_entity_[file_.count(0)];
        for (std::size_t k = 0; k < file_.count(groups); ++k)
          // A group can take an entity the other way round, with a negative tag.
          tags.push_back(static_cast<std::uint64_t>(std::abs(file_.number(groups + 1 + k))));
      }
  }

  void read_nodes_2() {
    next();
    for (std::uint64_t n = file_.count(0); n > 0; --n) {
      next();
      add_node(file_.count(0), 1);
    }
  }

  void read_nodes_4() {
    next();
    for (std::uint64_t blocks = file_.count(0); blocks > 0; --blocks) {
      next();
      std::vector<std::uint64_t> tags;
      for (std::uint64_t n = file_.count(3); n > 0; --n) {
        next();
        tags.push_back(file_.count(0));
      }
      for (const std::uint64_t tag : tags) {
        next();
        add_node(tag, 0);
      }
    }
  }

  void read_elements_2() {
    const std::optional<std::uint64_t> wanted = wanted_group();
    next();
    for (std::uint64_t n = file_.count(0); n > 0; --n) {
      next();
      const std::uint64_t type = file_.count(1), tags = file_.count(2);
      if (!wanted || (tags > 0 && file_.count(3) == *wanted))
        add_element(type, 3 + tags);
    }
  }

  void read_elements_4() {
    const std::optional<std::uint64_t> wanted = wanted_group();
    next();
    for (std::uint64_t blocks = file_.count(0); blocks > 0; --blocks) {
      next();
      const bool has_facets = file_.count(0) == facet_dim;
      const auto& groups = groups_of_entity_[file_.count(1)];
      const bool is_wanted =
          has_facets && (!wanted || std::ranges::find(groups, *wanted) != groups.end());
      const std::uint64_t type = file_.count(2);
      for (std::uint64_t n = file_.count(3); n > 0; --n) {
        next();
        if (is_wanted)
          add_element(type, 1);
      }
    }
  }

  /// Tag of the group that is asked for, if one is.
  std::optional<std::uint64_t> wanted_group() const {
    if (physical_name_.empty())
      return std::nullopt;
    if (const auto found = tag_of_name_.find(physical_name_); found != tag_of_name_.end())
      return found->second;
    std::vector<std::string> names;
    for (const auto& [name, tag] : tag_of_name_)
      names.push_back(name);
    const std::string meant = nearest(physical_name_, names);
    throw FileError(fmt::format(
        "{} has no physical {} \"{}\"{}; it has {}", path_.string(), dim == 2 ? "curve" : "surface",
        physical_name_, meant.empty() ? "" : fmt::format(", did you mean \"{}\"?", meant),
        names.empty() ? std::string("none") : fmt::format("{}", fmt::join(names, ", "))));
  }

  /// @param word  the first coordinate in this line
  void add_node(std::uint64_t tag, std::size_t word) {
    Vec<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = file_.number(word + static_cast<std::size_t>(a));
    if (dim == 2 && file_.number(word + 2) != 0.0)
      file_.fail(
          fmt::format("a node of a model in 2D must have z = 0, not {}", file_.number(word + 2)));
    node_of_tag_[tag] = static_cast<std::uint32_t>(surface_.vertices.size());
    surface_.vertices.push_back(x);
  }

  /// @param word  the first node in this line
  void add_element(std::uint64_t type, std::size_t word) {
    // Types: 1 line, 2 triangle, 3 quadrangle; 8, 9, 10, 16 the same of second order.
    constexpr std::uint64_t flat = dim == 2 ? 1 : 2;
    const bool is_quadrangle = dim == 3 && type == 3;
    if (dim == 2 ? type == 8 : type == 9 || type == 10 || type == 16)
      file_.fail("the facets are curved, but must be flat: mesh with -order 1");
    if (type != flat && !is_quadrangle)
      return;
    add_facet({word, word + 1, word + dim - 1});
    if (is_quadrangle)
      add_facet({word, word + 2, word + 3});
  }

  /// @param words  where the tags of its nodes stand; a segment has the first and the last
  void add_facet(const std::array<std::size_t, 3>& words) {
    Facet<dim> facet;
    for (std::size_t k = 0; k < dim; ++k) {
      const std::uint64_t tag = file_.count(words[k]);
      const auto node = node_of_tag_.find(tag);
      if (node == node_of_tag_.end())
        file_.fail(fmt::format("there is no node {}", tag));
      facet[k] = node->second;
    }
    surface_.facets.push_back(facet);
    line_.push_back(file_.line_number());
  }

  std::filesystem::path path_;
  TextFile file_;
  std::string physical_name_;
  double version_ = 0.0;
  std::map<std::string, std::uint64_t> tag_of_name_;
  std::map<std::uint64_t, std::vector<std::uint64_t>> groups_of_entity_;
  std::unordered_map<std::uint64_t, std::uint32_t> node_of_tag_;
  Surface<dim> surface_;
  std::vector<std::size_t> line_; // of each facet
};

} // namespace

template <int dim>
Surface<dim> read_gmsh_surface(const std::filesystem::path& path, std::string_view physical_name) {
  return GmshReader<dim>(path, physical_name).read();
}

template Surface<2> read_gmsh_surface<2>(const std::filesystem::path&, std::string_view);
template Surface<3> read_gmsh_surface<3>(const std::filesystem::path&, std::string_view);

} // namespace kerf
