// A camera on a sphere around a target, moved by mouse. No OpenGL, no window.
#pragma once

#include "camera/camera.h"

namespace prt::runtime {

class Orbit {
 public:
  Orbit() : Orbit(camera::frame({}, 40.0f, 1.0f)) {}
  /// Starts where a camera stands; its up direction becomes +Y.
  explicit Orbit(const camera::Camera& camera);

  camera::Camera camera(float aspect) const;

  /// Mouse movements in pixels of a window `height` pixels high, y down. Rotating never passes the
  /// poles; panning moves what is under the mouse along with it, at the target's distance.
  void rotate(float dx, float dy, float height);
  void pan(float dx, float dy, float height);
  /// Wheel steps: positive comes nearer.
  void zoom(float steps);

 private:
  Vec3 target_;
  float distance_, yaw_, pitch_;  // radians; yaw 0 looks from +Z
  float vertical_fov_;            // degrees
};

}  // namespace prt::runtime
