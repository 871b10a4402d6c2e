/* Turns the UAV towards an anchor: the "face anchor" task in plain C99, with only Tether's client library.
 *
 * usage: face_anchor_c ANCHOR
 *
 * `tether run` starts it (see face_anchor.toml). Exit code: 0 if it faces the anchor, 1 if it does not, 2 for wrong
 * use, 3 if the connection failed. */

#include <math.h>
#include <stdio.h>

#include <tether/client.h>

static const double kPi = 3.14159265358979323846;
static const double kGain_per_s = 1.2;
static const int kImagesInARow = 3;
static const int64_t kTimeLimit_ns = INT64_C(40000000000); /* execution time, like every time here */
static const int64_t kRest_ns = INT64_C(500000000);

/* Light and shade change the brightness of a surface, but hardly its colour. A pixel belongs to the anchor if its
 * vector in the colour space has the anchor's direction, and if it is not too dark. */
static int has_color(const uint8_t* rgb, const tether_vec3* color) {
  const double r = rgb[0], g = rgb[1], b = rgb[2];
  const double dot = r * color->x + g * color->y + b * color->z;
  const double pixel = r * r + g * g + b * b;
  const double wanted = color->x * color->x + color->y * color->y + color->z * color->z;
  return pixel > 50.0 * 50.0 && dot * dot > 0.9 * pixel * wanted;
}

/* Mean column of the anchor's pixels. Returns 0 if there are too few pixels. */
static int find_column(const tether_image* image, const tether_image_info* info, const tether_vec3* color,
                       double* u_px) {
  const uint8_t* rgb = tether_image_rgb(image);
  double sum = 0.0;
  int count = 0, u, v;
  for (v = 0; v < info->height_px; ++v)
    for (u = 0; u < info->width_px; ++u, rgb += 3)
      if (has_color(rgb, color)) {
        sum += u;
        ++count;
      }
  if (count < info->width_px * info->height_px / 5000) return 0;
  *u_px = sum / count;
  return 1;
}

static void tell(tether_vehicle* vehicle, const char* anchor, uint64_t image_index, double bearing_rad, int converged) {
  char json[256];
  snprintf(json, sizeof json,
           "{\"anchor\": \"%s\", \"camera\": \"camera\", \"image_index\": %llu, \"bearing_rad\": %.6f, "
           "\"distance_m\": null, \"converged\": %s}",
           anchor, (unsigned long long)image_index, bearing_rad, converged ? "true" : "false");
  /* A failed annotation need not stop the flight; the next call reports a lost connection. */
  (void)tether_annotate(vehicle, "estimate", json);
}

/* Reads one image: *seen = 1 and the bearing [rad], positive to the left, or *seen = 0 without the anchor. */
static tether_status look(tether_vehicle* vehicle, const tether_vec3* color, const tether_camera_model* lens, int* seen,
                          uint64_t* index, double* bearing_rad) {
  tether_image* image = NULL;
  tether_image_info info;
  double u_px = 0.0;
  tether_status status = tether_read_camera(vehicle, "camera", TETHER_READ_NEXT, &image);
  if (status != TETHER_OK) return status;
  status = tether_image_get_info(image, &info, sizeof info);
  *seen = status == TETHER_OK && find_column(image, &info, color, &u_px);
  *index = info.index;
  *bearing_rad = atan((lens->cx_px - u_px) / lens->fx_px);
  tether_image_free(image);
  return status;
}

/* Turns until the UAV faces the anchor (*faced = 1) or the time limit is reached. */
static tether_status face(tether_vehicle* vehicle, const tether_anchor* anchor, const tether_camera_model* lens,
                          int* faced) {
  const int64_t begin_ns = tether_now(vehicle);
  const double precision_rad = 2.0 * kPi / 180.0, fastest_rad_s = 25.0 * kPi / 180.0;
  double yaw_rate_rad_s = fastest_rad_s; /* turns left until it sees the anchor */
  int in_a_row = 0;
  tether_vec3 color;
  tether_status status = tether_anchor_color(anchor, &color);
  *faced = 0;
  while (status == TETHER_OK && in_a_row < kImagesInARow) {
    int seen = 0;
    uint64_t index = 0;
    double bearing_rad = 0.0;
    if (tether_now(vehicle) - begin_ns > kTimeLimit_ns) return TETHER_OK;
    status = look(vehicle, &color, lens, &seen, &index, &bearing_rad);
    if (status != TETHER_OK) return status;
    if (seen) {
      in_a_row = fabs(bearing_rad) <= precision_rad ? in_a_row + 1 : 0;
      yaw_rate_rad_s = fmin(fmax(kGain_per_s * bearing_rad, -fastest_rad_s), fastest_rad_s);
      tell(vehicle, tether_anchor_name(anchor), index, bearing_rad, in_a_row == kImagesInARow);
    }
    status = tether_command_velocity(vehicle, 0.0, 0.0, 0.0, yaw_rate_rad_s);
  }
  if (status == TETHER_OK) status = tether_command_velocity(vehicle, 0.0, 0.0, 0.0, 0.0);
  if (status == TETHER_OK) status = tether_sleep_for(vehicle, kRest_ns);
  *faced = status == TETHER_OK;
  return status;
}

/* Gets the anchor and the lens, flies, and finishes. Returns the exit code. */
static int fly(tether_vehicle* vehicle, const char* name) {
  const tether_anchor* anchor = tether_find_anchor(vehicle, name);
  const tether_sensor* camera = tether_find_sensor(vehicle, "camera");
  tether_camera_model lens;
  int faced = 0;
  if (anchor == NULL || camera == NULL || tether_sensor_camera_model(camera, &lens, sizeof lens) != TETHER_OK) {
    fprintf(stderr, "face_anchor_c: there is no anchor %s, or no camera named camera\n", name);
    (void)tether_finish(vehicle, 0, "there is no such anchor, or no camera", "");
    return 2;
  }
  if (face(vehicle, anchor, &lens, &faced) != TETHER_OK ||
      tether_finish(vehicle, faced, faced ? "faces the anchor" : "time limit", "") != TETHER_OK) {
    fprintf(stderr, "face_anchor_c: %s\n", tether_last_error());
    return 3;
  }
  return faced ? 0 : 1;
}

int main(int argc, char** argv) {
  tether_vehicle* vehicle = NULL;
  int code;
  if (argc != 2) {
    fprintf(stderr, "usage: face_anchor_c ANCHOR\n");
    return 2;
  }
  if (tether_connect(NULL, &vehicle) != TETHER_OK) { /* settings from the environment */
    fprintf(stderr, "face_anchor_c: %s\n", tether_last_error());
    return 3;
  }
  code = fly(vehicle, argv[1]);
  tether_disconnect(vehicle);
  return code;
}
