# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Every number of the robot: geometry, masses, servos, limits, pose, timing and names.

hexapod.xml repeats these numbers for MuJoCo; a test compiles it and compares each one. Nothing
here needs MuJoCo, so that the pattern generator and the drivers of a real robot can use it too.
Units are SI and radians.
"""

import math

import numpy as np

# Legs in the order of every leg vector: left and right, front, middle and rear.
LEGS = ('lf', 'lm', 'lr', 'rf', 'rm', 'rr')
LEG_JOINTS = ('hip', 'knee', 'ankle')
# Joint vectors are leg-major: lf_hip, lf_knee, lf_ankle, lm_hip, ...
JOINTS = tuple(f'{leg}_{joint}' for leg in LEGS for joint in LEG_JOINTS)

# Frames after REP-103 and REP-105: x forward, y left, z up.
ODOM_FRAME = 'odom'
BASE_FRAME = 'base_link'
IMU_FRAME = 'imu_link'
HEIGHT_FRAME = 'height_link'
# Origin at the foot's centre; axes parallel to odom, so that z is the floor's normal.
FOOT_FRAMES = tuple(f'{leg}_foot' for leg in LEGS)

# Timing. One control period carries SUBSTEPS joint targets, TARGET_PERIOD_NS apart.
CONTROL_PERIOD_NS = 25_000_000
SUBSTEPS = 5
TARGET_PERIOD_NS = CONTROL_PERIOD_NS // SUBSTEPS
PHYSICS_STEP_NS = 5_000_000

# Link lengths [m] between joint axes; the tibia ends at the centre of the foot's sphere.
COXA_LENGTH = 0.052
FEMUR_LENGTH = 0.066
TIBIA_LENGTH = 0.133
FOOT_RADIUS = 0.012
# Radii of the capsules that links are made of [m].
COXA_RADIUS = 0.016
FEMUR_RADIUS = 0.014
TIBIA_RADIUS = 0.010

# Where each leg's hip axis stands in base_link [m], and the yaw [rad] at which a leg with hip
# angle zero points away from the body. Front and rear legs splay so that the feet span a wide
# support polygon and neighbours never meet within the hip range of the gait.
HIP_POSITIONS = np.array(
    [
        [0.125, 0.062, 0.0],
        [0.0, 0.103, 0.0],
        [-0.125, 0.062, 0.0],
        [0.125, -0.062, 0.0],
        [0.0, -0.103, 0.0],
        [-0.125, -0.062, 0.0],
    ]
)
HIP_SPLAY = math.pi / 6
HIP_YAWS = np.array(
    [
        math.pi / 2 - HIP_SPLAY,
        math.pi / 2,
        math.pi / 2 + HIP_SPLAY,
        -math.pi / 2 + HIP_SPLAY,
        -math.pi / 2,
        -math.pi / 2 - HIP_SPLAY,
    ]
)
# Half sizes of the body's box [m].
BODY_HALF_SIZE = (0.125, 0.062, 0.022)

# Masses [kg]. Each leg carries three servos of 55 g, and brackets.
BODY_MASS = 1.08
COXA_MASS = 0.06
FEMUR_MASS = 0.10
TIBIA_MASS = 0.055
FOOT_MASS = 0.005
TOTAL_MASS = BODY_MASS + len(LEGS) * (COXA_MASS + FEMUR_MASS + TIBIA_MASS + FOOT_MASS)
# Gravity [m/s^2], towards the floor: MuJoCo's default, which the model keeps.
GRAVITY = 9.81

# Servos. Stall torque [N m] and no-load speed [rad/s] (59 rev/min) of the AX-12A class.
TORQUE_LIMIT = 1.5
NO_LOAD_SPEED = 6.2
# Proportional band [rad]: the servo gives its full torque at this position error (compliance
# slope 16 of the AX series, 16 steps of 0.29 degrees).
PROPORTIONAL_BAND = 0.082
SERVO_KP = TORQUE_LIMIT / PROPORTIONAL_BAND
# Back-EMF: the torque of a DC motor falls linearly from stall to zero at the no-load speed.
SERVO_DAMPING = TORQUE_LIMIT / NO_LOAD_SPEED
# Rotor inertia seen through the gear [kg m^2]: 254^2 times about 1e-7 kg m^2.
SERVO_ARMATURE = 0.0065

# Joint limits [rad] per leg: hip, knee, ankle.
LEG_LOWER = np.array([-0.9, -1.2, -1.2])
LEG_UPPER = np.array([0.9, 1.2, 1.2])
JOINT_LOWER = np.tile(LEG_LOWER, len(LEGS))
JOINT_UPPER = np.tile(LEG_UPPER, len(LEGS))

# Standing pose [rad] per leg. Hip zero: the leg points along its splay direction. Knee zero: the
# femur is level, positive raises the foot. Ankle zero: the tibia is square to the femur (straight
# down under a level femur), positive swings it outwards and up.
NEUTRAL_LEG = np.array([0.0, 0.25, 0.0])
NEUTRAL_POSE = np.tile(NEUTRAL_LEG, len(LEGS))
# Height [m] of base_link with rigid servos: tibia's drop, less the femur's rise, plus the foot.
STANDING_HEIGHT = (
    TIBIA_LENGTH * math.cos(NEUTRAL_LEG[1] + NEUTRAL_LEG[2])
    - FEMUR_LENGTH * math.sin(NEUTRAL_LEG[1])
    + FOOT_RADIUS
)

# Sign that turns "foot forwards" into a hip angle: hips turn about +z, so a left foot (at +y)
# moves forwards when its hip angle falls.
HIP_FORWARD_SIGN = np.array([-1.0, -1.0, -1.0, 1.0, 1.0, 1.0])

# Largest distance [m] that the range finder under the body reports; beyond it sees nothing.
HEIGHT_RANGE_MAX = 1.0
