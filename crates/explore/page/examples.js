// Parts of a scene that the editor appends to a text in x, y and phi, such as that of the sledge: each a table of its own.

export const EXAMPLES = [
  ["An observable", `[observables]
speed = "sqrt(x'^2 + y'^2)"   # a column and a curve of its own
`],
  ["A quantity that should be constant", `[invariants]
spin = "phi'"                 # deltaq reports how much it drifts
`],
  ["A force", `[system.forces]
x = "-0.1*x'"                 # along x: drag
`],
  ["Multipliers at the start", `[vakonomic]
multipliers = [0.5]           # one per constraint
`],
  ["A body that is drawn", `[view.box]
shape = "box"
size = [0.6, 0.3, 0.2]
at = "[x, y, 0.1]"
rotation = "phi"
`],
  ["A body with mass", `[body.rider]
joint = { plane = ["x", "y", "phi"] }   # its energy is added to the Lagrangian
shape = "box"
size = [0.4, 0.2, 0.6]
mass = 2                      # kg
inertia = [0.07, 0.09, 0.03]  # kg m², about its axes
`],
].map(([name, text]) => ({ name, text }));
