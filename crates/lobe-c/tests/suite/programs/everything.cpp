// Uses everything in lobe.hpp: everything FILE.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include "lobe.hpp"

namespace {

std::uint32_t state = 1;

float random_number() {
  state = state * 1664525u + 1013904223u;
  return float(state >> 8) / 16777216.0f;
}

lobe::Vector direction() {
  const float x = random_number() - 0.5f, y = random_number() - 0.5f, z = random_number() + 0.01f;
  const float length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

std::uint64_t hash(const std::vector<float> &values) {
  std::uint64_t hash = 14695981039346656037u;
  for (const float value : values) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 1099511628211u;
  }
  return hash;
}

void check(bool is_right, const char *what, int line) {
  if (is_right) return;
  std::fprintf(stderr, "line %d: %s\n", line, what);
  std::exit(3);
}

#define CHECK(condition) check((condition), #condition, __LINE__)

}  // namespace

int main(int argc, char **argv) try {
  CHECK(argc == 2);
  const std::size_t count = 20000;
  std::vector<lobe::Vector> wi(count), wo(count);
  for (std::size_t i = 0; i < count; ++i) {
    wi[i] = direction();
    wo[i] = direction();
  }
  lobe::Options options;
  options.strict = true;
  const lobe::Material material = lobe::Material::open(argv[1], options);
  CHECK(material.channel_count() == 3 && material.channels() == (std::vector<std::string>{"R", "G", "B"}));
  CHECK(material.wavelengths().empty() && material.kind() == "specular table" && !material.format().empty());
  CHECK(material.holds(LOBE_REFLECTION) && !material.holds(LOBE_TRANSMISSION));
  CHECK(!material.is_isotropic() && !lobe::backends().empty() && !material.backend().empty());
  for (const auto &fact : material.facts()) CHECK(!fact.first.empty());

  const std::vector<float> f = material.eval(wi, wo);
  std::printf("%016llx\n", static_cast<unsigned long long>(hash(f)));
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  const lobe::Material copy = lobe::Material::from_bytes(bytes.data(), bytes.size(), "copy.ddr", options);
  CHECK(copy.eval(wi, wo) == f);
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) threads.emplace_back([=, &wi, &wo, &f] { CHECK(material.eval(wi, wo) == f); });
  for (std::thread &thread : threads) thread.join();
  CHECK(material.eval(std::vector<lobe::Vector>(), std::vector<lobe::Vector>()).empty());
  const std::vector<float> one = material.eval(wi[3], wo[3]);
  CHECK(std::memcmp(one.data(), f.data() + 9, 3 * sizeof(float)) == 0);

  lobe::Sampler sampler = lobe::Material(material).sampler();
  for (int i = 0; i < 100; ++i) {
    const lobe::Sample drawn = sampler.sample(wi[0], {random_number(), random_number()});
    CHECK(drawn.pdf == 0.0f || std::fabs(sampler.pdf(wi[0], drawn.direction) / drawn.pdf - 1.0f) < 5e-3f);
    CHECK(drawn.weight.size() == 3);
  }

  try {
    lobe::Material::open("missing.ddr");
    CHECK(false);
  } catch (const lobe::Error &error) {
    CHECK(error.status() == LOBE_ERROR_FORMAT && std::strstr(error.what(), "missing.ddr") != nullptr);
    CHECK(!error.line() && !error.byte());
  }
  try {
    material.mueller(wi[0], wo[0], 550.0);
    CHECK(false);
  } catch (const lobe::Error &error) {
    CHECK(error.status() == LOBE_ERROR_UNSUPPORTED);
  }
  try {
    material.eval(wi, std::vector<lobe::Vector>{wo[0], wo[1]});
    CHECK(false);
  } catch (const std::invalid_argument &) {
  }
  return 0;
} catch (const std::exception &error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
