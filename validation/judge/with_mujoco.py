"""MuJoCo: the table is a cylinder on a hinge, whose rate is set to Omega before each step. Licence Apache-2.0.

A mocap body would not do: MuJoCo gives it no velocity, so its contacts stand still.
"""

import mujoco
import numpy as np

import turntable

SETTINGS = {  # as shipped; with a friction of 10 the pyramids are so soft that the ball falls through the table
    "engine": f"MuJoCo {mujoco.__version__}",
    "integrator": "Euler",
    "solver": "Newton",
    "iterations": 100,
    "tolerance": 1e-8,  # relative to the mean inertia
    "cone": "pyramidal",  # or elliptic
    "impratio": 1.0,  # stiffness of friction over that of the normal force
    "noslip_iterations": 0,
    "solref": [0.02, 1.0],  # time constant, s, and damping ratio of contacts; at least two steps long
    "solimp": [0.9, 0.95, 0.001, 0.5, 2.0],
    "friction": 1.0,
    "table_inertia": 1e3,  # kg m²; 1e6 loosens the tolerance so much that the ball gets a false spin
    "settle": 2.0,  # s, that the ball sinks in on a table at rest, before the start
}


def model(ball, dt):
    s = SETTINGS
    solref, solimp = (" ".join(map(str, s[name])) for name in ("solref", "solimp"))
    contact = f"""friction="{s['friction']} 0 0" condim="3" solref="{solref}" solimp="{solimp}" """
    inertia = 0.4 * ball.m * ball.a**2
    heavy = 'diaginertia="{0} {0} {0}"'.format(s["table_inertia"])
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
      <option timestep="{dt}" gravity="0 0 {-turntable.GRAVITY}" integrator="{s['integrator']}" solver="{s['solver']}"
        iterations="{s['iterations']}" tolerance="{s['tolerance']}" cone="{s['cone']}" impratio="{s['impratio']}"
        noslip_iterations="{s['noslip_iterations']}"/>
      <worldbody>
        <body name="table" pos="0 0 -0.5"><joint name="axle" type="hinge" axis="0 0 1"/>
          <inertial pos="0 0 0" mass="1" {heavy}/>
          <geom type="cylinder" size="5 0.5" {contact}/></body>
        <body name="ball" pos="0 0 {ball.a}"><freejoint name="free"/>
          <inertial pos="0 0 0" mass="{ball.m}" diaginertia="{inertia} {inertia} {inertia}"/>
          <geom type="sphere" size="{ball.a}" {contact}/></body>
      </worldbody></mujoco>""")


def motion(ball, dt, steps, every):
    m = model(ball, dt)
    d = mujoco.MjData(m)
    axle, free = m.joint("axle"), m.joint("free")
    q, v, hinge = free.qposadr[0], free.dofadr[0], axle.dofadr[0]
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, ball.rotation.ravel())
    for _ in range(round(SETTINGS["settle"] / dt)):
        mujoco.mj_step(m, d)
    d.qpos[q : q + 7] = [*ball.centre[:2], d.qpos[q + 2], *quaternion]
    d.qvel[v : v + 6] = [*ball.velocity, *(ball.rotation.T @ ball.spin)]  # spin in the axes of the ball
    for k in range(steps + 1):
        if k % every == 0:
            R = np.zeros(9)
            mujoco.mju_quat2Mat(R, d.qpos[q + 3 : q + 7])
            R = R.reshape(3, 3)
            yield k * dt, d.qpos[q : q + 3].copy(), R, d.qvel[v : v + 3].copy(), R @ d.qvel[v + 3 : v + 6]
        d.qvel[hinge] = ball.Omega
        mujoco.mj_step(m, d)


if __name__ == "__main__":
    turntable.run(SETTINGS, motion, __doc__)
