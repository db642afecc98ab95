"""PyBullet: the table is a plane on a revolute joint, whose rate is set to Omega before each step. Licence Zlib."""

import importlib.metadata

import numpy as np
import pybullet

import turntable

SETTINGS = {
    "engine": f"PyBullet {importlib.metadata.version('pybullet')}",
    "numSolverIterations": 50,  # as shipped, like all to friction
    "solverResidualThreshold": 1e-7,
    "numSubSteps": 0,
    "enableConeFriction": 1,
    "erp": 0.2,
    "contactERP": 0.08,
    "frictionERP": 0.2,
    "globalCFM": 0.0,
    "friction": 0.5,  # of both bodies; that of the contact is the product
    "damping": 0.0,  # linear and angular, 1/s; shipped 0.04
    "motor": 1e9,  # N m, largest torque that keeps the table's rate
    "settle": 1.0,  # s, that the ball sinks in on a table at rest, before the start
}


def world(ball, dt):
    s = SETTINGS
    pybullet.connect(pybullet.DIRECT)
    pybullet.setGravity(0, 0, -turntable.GRAVITY)
    of_ours = ["engine", "friction", "damping", "motor", "settle"]
    pybullet.setPhysicsEngineParameter(fixedTimeStep=dt, **{name: s[name] for name in s if name not in of_ours})
    plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE, planeNormal=[0, 0, 1])
    still = {"linkPositions": [[0, 0, 0]], "linkOrientations": [[0, 0, 0, 1]], "linkInertialFramePositions": [[0, 0, 0]],
             "linkInertialFrameOrientations": [[0, 0, 0, 1]], "linkParentIndices": [0], "linkVisualShapeIndices": [-1]}
    table = pybullet.createMultiBody(0, linkMasses=[1], linkCollisionShapeIndices=[plane], linkJointTypes=[pybullet.JOINT_REVOLUTE],
                                     linkJointAxis=[[0, 0, 1]], **still)
    pybullet.changeDynamics(table, 0, localInertiaDiagonal=[1, 1, 1], lateralFriction=s["friction"], jointDamping=0.0)
    sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=ball.a)
    body = pybullet.createMultiBody(ball.m, sphere, basePosition=[0, 0, ball.a])
    inertia = 0.4 * ball.m * ball.a**2
    pybullet.changeDynamics(body, -1, localInertiaDiagonal=[inertia] * 3, lateralFriction=s["friction"], rollingFriction=0, spinningFriction=0,
                            linearDamping=s["damping"], angularDamping=s["damping"], maxJointVelocity=1e6)
    pybullet.changeDynamics(body, -1, activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING)
    return table, body


def quaternion(R):
    """x, y, z, w of a rotation by less than half a turn."""
    w = np.sqrt(1 + np.trace(R)) / 2
    return [(R[2, 1] - R[1, 2]) / (4 * w), (R[0, 2] - R[2, 0]) / (4 * w), (R[1, 0] - R[0, 1]) / (4 * w), w]


def motion(ball, dt, steps, every):
    table, body = world(ball, dt)
    for _ in range(round(SETTINGS["settle"] / dt)):
        pybullet.stepSimulation()
    height = pybullet.getBasePositionAndOrientation(body)[0][2]
    pybullet.resetBasePositionAndOrientation(body, [*ball.centre[:2], height], quaternion(ball.rotation))
    pybullet.resetBaseVelocity(body, ball.velocity.tolist(), ball.spin.tolist())
    for k in range(steps + 1):
        if k % every == 0:
            centre, turned = pybullet.getBasePositionAndOrientation(body)
            velocity, spin = pybullet.getBaseVelocity(body)
            R = np.array(pybullet.getMatrixFromQuaternion(turned)).reshape(3, 3)
            yield k * dt, np.array(centre), R, np.array(velocity), np.array(spin)
        pybullet.resetJointState(table, 0, ball.Omega * k * dt, ball.Omega)
        pybullet.setJointMotorControl2(table, 0, pybullet.VELOCITY_CONTROL, targetVelocity=ball.Omega, force=SETTINGS["motor"])
        pybullet.stepSimulation()


if __name__ == "__main__":
    turntable.run(SETTINGS, motion, __doc__)
