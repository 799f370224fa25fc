// Measured BRDFs and BSDFs for C++17: a thin layer over lobe.h, in this header alone.
//
// Directions are unit vectors away from the surface, whose normal is +z: wi points to the light, wo to the viewer. Values are f
// in 1/sr, without the cosine, one per channel. Errors are exceptions of the class lobe::Error. Materials and samplers are
// immutable: threads may share them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lobe.h"

namespace lobe {

/// The error of a function that failed.
class Error : public std::runtime_error {
 public:
  explicit Error(const lobe_error &error) : std::runtime_error(error.message), error_(error) {}

  /// One of LOBE_ERROR_...
  lobe_status status() const noexcept { return error_.status; }

  /// The line of the file, counted from 1, if there is one.
  std::optional<std::uint64_t> line() const noexcept {
    return error_.line == 0 ? std::nullopt : std::optional<std::uint64_t>(error_.line);
  }

  /// The offset in the file in bytes, if there is one.
  std::optional<std::uint64_t> byte() const noexcept {
    return error_.byte == UINT64_MAX ? std::nullopt : std::optional<std::uint64_t>(error_.byte);
  }

 private:
  lobe_error error_;
};

namespace detail {

/// Calls a function of lobe.h, whose last argument receives the error.
template <class Function, class... Arguments>
void call(Function function, Arguments... arguments) {
  lobe_error error;
  if (function(arguments..., &error) != LOBE_OK) throw Error(error);
}

inline std::string text(const char *text) { return text == nullptr ? std::string() : std::string(text); }

}  // namespace detail

/// A direction.
using Vector = std::array<float, 3>;

/// Consecutive vectors, three numbers each.
inline lobe_directions vectors(const float *numbers) { return {numbers, numbers + 1, numbers + 2, 3}; }

/// Consecutive vectors.
inline lobe_directions vectors(const std::vector<Vector> &list) {
  static_assert(sizeof(Vector) == 3 * sizeof(float), "vectors have no padding");
  return list.empty() ? lobe_directions{nullptr, nullptr, nullptr, 3} : vectors(list.front().data());
}

/// Components in separate columns.
inline lobe_directions columns(const float *x, const float *y, const float *z) { return {x, y, z, 1}; }

/// Vectors with other numbers between them; `stride` is the distance from one to the next, in numbers.
inline lobe_directions strided(const float *numbers, std::size_t stride) {
  return {numbers, numbers + 1, numbers + 2, stride};
}

/// The same vector for all queries; it must live as long as the call.
inline lobe_directions same(const Vector &vector) { return strided(vector.data(), 0); }

/// Options for opening a material.
struct Options {
  /// The instruction set, one of backends(); empty means the best that this machine has.
  std::string backend;
  /// Round in the same way on all machines.
  bool strict = false;
  /// Keep each call on the thread that makes it.
  bool serial = false;
  /// One of LOBE_EDGES_...
  int edges = LOBE_EDGES_CLAMP;
  /// One of LOBE_LOOKUP_...
  int lookup = LOBE_LOOKUP_NEAREST;
  /// One of LOBE_GIVEN_...
  int indexed_by = LOBE_GIVEN_LIGHT;

  /// The options for lobe.h, which live as long as this object.
  lobe_options get() const {
    lobe_options options = lobe_options_default();
    options.backend = backend.empty() ? nullptr : backend.c_str();
    options.strict = strict;
    options.serial = serial;
    options.edges = edges;
    options.lookup = lookup;
    options.indexed_by = indexed_by;
    return options;
  }
};

/// The names of the backends that this machine can run, slowest first.
inline std::vector<std::string> backends() {
  std::vector<std::string> names;
  for (std::size_t index = 0; index < lobe_backend_count(); ++index) names.push_back(lobe_backend_name(index));
  return names;
}

class Sampler;

/// A measured material, in the representation in which it was measured. Copies share it.
class Material {
 public:
  /// Opens a file of any format.
  static Material open(const std::string &path, const Options &options = {}) {
    lobe_material *material = nullptr;
    const lobe_options chosen = options.get();
    detail::call(lobe_open, path.c_str(), &chosen, &material);
    return Material(material);
  }

  /// Opens the content of a file in memory, which is not used after the call.
  static Material from_bytes(const void *data, std::size_t size, const std::string &name = "memory",
                             const Options &options = {}) {
    lobe_material *material = nullptr;
    const lobe_options chosen = options.get();
    detail::call(lobe_open_bytes, static_cast<const std::uint8_t *>(data), size, name.c_str(), &chosen, &material);
    return Material(material);
  }

  /// f in 1/sr of `count` pairs, written to any layout of values.
  void eval(std::size_t count, lobe_directions wi, lobe_directions wo, lobe_values values) const {
    detail::call(lobe_eval, get(), count, wi, wo, values);
  }

  /// f in 1/sr, pair by pair: `[pair * channel_count() + channel]`.
  std::vector<float> eval(std::size_t count, lobe_directions wi, lobe_directions wo) const {
    std::vector<float> values(count * channel_count());
    eval(count, wi, wo, lobe_values{values.data(), channel_count(), 1});
    return values;
  }

  /// The same for lists of vectors of the same length.
  std::vector<float> eval(const std::vector<Vector> &wi, const std::vector<Vector> &wo) const {
    if (wi.size() != wo.size()) throw std::invalid_argument("as many wi as wo");
    return eval(wi.size(), vectors(wi), vectors(wo));
  }

  /// f in 1/sr of one pair, one value per channel.
  std::vector<float> eval(const Vector &wi, const Vector &wo) const { return eval(1, same(wi), same(wo)); }

  /// The Mueller matrix in 1/sr at a wavelength in nm, row by row.
  std::array<double, 16> mueller(const Vector &wi, const Vector &wo, double wavelength) const {
    std::array<double, 16> matrix;
    detail::call(lobe_mueller, get(), wi.data(), wo.data(), wavelength, matrix.data());
    return matrix;
  }

  /// A sampler of directions; building it takes a while.
  Sampler sampler(float defensive = 0.05f) const;

  std::size_t channel_count() const { return lobe_channel_count(get()); }

  std::vector<std::string> channels() const {
    std::vector<std::string> names;
    for (std::size_t channel = 0; channel < channel_count(); ++channel) {
      names.push_back(lobe_channel_name(get(), channel));
    }
    return names;
  }

  /// In nm; empty if channels are not wavelengths.
  std::vector<double> wavelengths() const {
    const double *list = lobe_wavelengths(get());
    return list == nullptr ? std::vector<double>() : std::vector<double>(list, list + channel_count());
  }

  /// Names and values of the header of the file.
  std::vector<std::pair<std::string, std::string>> facts() const {
    std::vector<std::pair<std::string, std::string>> facts;
    for (std::size_t index = 0; index < lobe_fact_count(get()); ++index) {
      const char *value = nullptr;
      const char *name = lobe_fact(get(), index, &value);
      facts.emplace_back(name, value);
    }
    return facts;
  }

  std::string kind() const { return detail::text(lobe_kind(get())); }
  std::string format() const { return detail::text(lobe_format(get())); }
  std::string backend() const { return detail::text(lobe_material_backend(get())); }
  bool is_isotropic() const { return lobe_is_isotropic(get()); }

  /// True if there are values for light from a side (LOBE_SIDE_...) that is reflected or transmitted.
  bool holds(int scatter, int side = LOBE_SIDE_FRONT) const { return lobe_holds(get(), scatter, side); }

  /// The handle of lobe.h, which this object owns.
  const lobe_material *get() const { return handle_.get(); }

 private:
  explicit Material(lobe_material *material) : handle_(material, lobe_material_free) {}

  std::shared_ptr<lobe_material> handle_;
};

/// A sampled direction.
struct Sample {
  Vector direction;
  /// Density per steradian; 0 if no direction was sampled, infinite for a mirror.
  float pdf;
  /// f times cosine over the density, one value per channel.
  std::vector<float> weight;
};

/// Samples directions in proportion to luminance times f times cosine. Copies share it.
class Sampler {
 public:
  explicit Sampler(Material material, float defensive = 0.05f) : material_(std::move(material)) {
    lobe_sampler *sampler = nullptr;
    detail::call(lobe_sampler_new, material_.get(), defensive, &sampler);
    handle_ = std::shared_ptr<lobe_sampler>(sampler, lobe_sampler_free);
  }

  /// Samples many directions; see lobe_sample.
  void sample(std::size_t count, lobe_directions directions, const float *u, lobe_values drawn, float *pdf,
              lobe_values weight = {nullptr, 0, 0}, int given = LOBE_GIVEN_LIGHT) const {
    detail::call(lobe_sample, get(), given, count, directions, u, drawn, pdf, weight);
  }

  /// Samples one direction.
  Sample sample(const Vector &direction, const std::array<float, 2> &u, int given = LOBE_GIVEN_LIGHT) const {
    Sample found{{}, 0.0f, std::vector<float>(material_.channel_count())};
    sample(1, same(direction), u.data(), lobe_values{found.direction.data(), 3, 1}, &found.pdf,
           lobe_values{found.weight.data(), found.weight.size(), 1}, given);
    return found;
  }

  /// Densities per steradian of many pairs, without mirrors.
  void pdf(std::size_t count, lobe_directions wi, lobe_directions wo, float *pdf, int given = LOBE_GIVEN_LIGHT) const {
    detail::call(lobe_pdf, get(), given, count, wi, wo, pdf);
  }

  /// The density of one pair.
  float pdf(const Vector &wi, const Vector &wo, int given = LOBE_GIVEN_LIGHT) const {
    float found = 0.0f;
    pdf(1, same(wi), same(wo), &found, given);
    return found;
  }

  const Material &material() const { return material_; }

  /// The handle of lobe.h, which this object owns.
  const lobe_sampler *get() const { return handle_.get(); }

 private:
  Material material_;
  std::shared_ptr<lobe_sampler> handle_;
};

inline Sampler Material::sampler(float defensive) const { return Sampler(*this, defensive); }

}  // namespace lobe
