"""Names in the shipped systems that entries use, as a user's script would."""

RIG = "test_rig"
GEARBOX = "gearbox"

GEAR = "gear_mesh"
BEARINGS = "bearing_supports"
HOUSING = "modal_housing"
CONTROLLER = "bench_controller"
