// Prints the albedo of a material, found by importance sampling: albedo FILE.
#include <cmath>
#include <cstdio>
#include <vector>

#include "lobe.hpp"

int main(int argc, char **argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: albedo FILE\n");
    return 2;
  }
  const lobe::Material material = lobe::Material::open(argv[1]);
  const lobe::Sampler sampler = material.sampler();
  const std::vector<std::string> channels = material.channels();
  const std::size_t n = 128, count = n * n;
  std::vector<float> u(2 * count), directions(3 * count), pdf(count), weight(channels.size() * count);
  for (std::size_t i = 0; i < count; ++i) {
    u[2 * i] = (float(i % n) + 0.5f) / float(n);
    u[2 * i + 1] = (float(i / n) + 0.5f) / float(n);
  }
  const lobe::Vector light = {0.6f, 0.0f, 0.8f};
  sampler.sample(count, lobe::same(light), u.data(), {directions.data(), 3, 1}, pdf.data(),
                 {weight.data(), channels.size(), 1});
  for (std::size_t channel = 0; channel < channels.size(); ++channel) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += weight[i * channels.size() + channel];
    std::printf("%s %.4f\n", channels[channel].c_str(), sum / double(count));
  }
  return 0;
} catch (const lobe::Error &error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
