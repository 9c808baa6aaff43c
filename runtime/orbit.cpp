#include "runtime/orbit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt::runtime {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kMaxPitch = 0.495f * kPi;
constexpr float kZoomStep = 0.9f;

}  // namespace

Orbit::Orbit(const camera::Camera& camera)
    : target_(camera.target), vertical_fov_(camera.vertical_fov) {
  const Vec3 eye_from_target = camera.eye - camera.target;
  distance_ = eye_from_target.length();
  yaw_ = std::atan2(eye_from_target.x, eye_from_target.z);
  pitch_ = std::clamp(std::asin(eye_from_target.y / distance_), -kMaxPitch, kMaxPitch);
}

camera::Camera Orbit::camera(float aspect) const {
  camera::Camera camera;
  camera.target = target_;
  camera.eye = target_ + Vec3(std::sin(yaw_) * std::cos(pitch_), std::sin(pitch_),
                              std::cos(yaw_) * std::cos(pitch_)) *
                             distance_;
  camera.vertical_fov = vertical_fov_;
  camera.aspect = aspect;
  return camera;
}

void Orbit::rotate(float dx, float dy, float height) {
  const float radians_per_pixel = kPi / height;
  yaw_ -= dx * radians_per_pixel;
  pitch_ = std::clamp(pitch_ + dy * radians_per_pixel, -kMaxPitch, kMaxPitch);
}

void Orbit::pan(float dx, float dy, float height) {
  const camera::Camera::Axes axes = camera(1.0f).axes();
  const float world_per_pixel = 2.0f * distance_ * std::tan(vertical_fov_ * kPi / 360.0f) / height;
  target_ += (axes.up * dy - axes.right * dx) * world_per_pixel;
}

void Orbit::zoom(float steps) { distance_ *= std::pow(kZoomStep, steps); }

}  // namespace prt::runtime
