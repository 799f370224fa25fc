/* Prints values of a material for one direction to the light and many to the viewer: eval FILE. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "lobe.h"

enum { VIEWERS = 7 };

int main(int argc, char **argv) {
  if (argc != 2) {
    fprintf(stderr, "usage: eval FILE\n");
    return 2;
  }
  lobe_options options = lobe_options_default();
  options.strict = true;
  lobe_material *material = NULL;
  lobe_error error;
  if (lobe_open(argv[1], &options, &material, &error) != LOBE_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  const size_t channels = lobe_channel_count(material);
  printf("# %s, %zu channels\n", lobe_kind(material), channels);

  const float wi[3] = {0.6f, 0.0f, 0.8f};
  float wo[VIEWERS][3];
  for (int i = 0; i < VIEWERS; ++i) {
    const float angle = 0.2f * (float)i;
    wo[i][0] = -sinf(angle);
    wo[i][1] = 0.0f;
    wo[i][2] = cosf(angle);
  }
  float *f = malloc(VIEWERS * channels * sizeof *f);
  const lobe_directions light = {wi, wi + 1, wi + 2, 0}; /* the same light for all */
  const lobe_directions viewers = {wo[0], wo[0] + 1, wo[0] + 2, 3};
  const lobe_values values = {f, channels, 1};
  const lobe_status status = lobe_eval(material, VIEWERS, light, viewers, values, &error);
  if (status != LOBE_OK) fprintf(stderr, "%s\n", error.message);
  for (int i = 0; i < VIEWERS && status == LOBE_OK; ++i) {
    printf("%.9g %.9g %.9g", wo[i][0], wo[i][1], wo[i][2]);
    for (size_t channel = 0; channel < channels; ++channel) printf(" %.9g", f[i * channels + channel]);
    printf("\n");
  }
  free(f);
  lobe_material_free(material);
  return status == LOBE_OK ? 0 : 1;
}
