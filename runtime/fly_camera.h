// A camera that flies through the scene.
#pragma once
#include "runtime/camera.h"

/// The user's input since the last frame.
struct FlyInput
{
    float right = 0, up = 0, forward = 0; // -1..1
    float yaw = 0, pitch = 0;             // radians, positive: to the left, upwards
    float faster = 0;                     // notches of the wheel
    bool fast = false;                    // for this frame only

    bool moves() const { return right != 0 || up != 0 || forward != 0 || yaw != 0 || pitch != 0; }
};

class FlyCamera
{
public:
    /// @param scene_size metres, the diagonal of the scene's box; decides how fast it flies
    FlyCamera(const Camera& start, float scene_size);

    void jump(const Camera& to) { camera_ = to; }
    /// Flies for `seconds`. Without motion or turning the camera stays the same to the last bit.
    void move(const FlyInput& input, float seconds);

    const Camera& camera() const { return camera_; }
    float speed() const { return speed_; } // metres a second

private:
    void turn(float yaw, float pitch);
    Camera camera_;
    float slowest_, fastest_, speed_;
};
