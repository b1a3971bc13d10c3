"""Run an .ssp file in another master: `python run_master.py MASTER FILE REQUEST ANSWER`.

In a process of its own, because these masters write to the terminal and may end the process.
Request (JSON): step [s]; count of macro steps; every (macro steps per record); names of results
`instance.variable`; parameter_set for ecos. libcosim also takes the folder of an unpacked file, and
then reads OspSystemStructure.xml.
Answer (JSON): one row of values per record, the start left out.
"""

import json
import os
import sys
from pathlib import Path


def libcosim(file, request):
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.ERROR)
    if Path(file).is_dir():
        execution = CosimExecution.from_osp_config_file(osp_path=file)
    else:
        execution = CosimExecution.from_ssp_file(ssp_path=file)
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer=observer)
    places = {
        f"{slave.name.decode()}.{variable.name.decode()}": (slave.index, variable.reference)
        for slave in execution.slave_infos()
        for variable in execution.slave_variables(slave.index)
    }

    def result(name):
        slave, reference = places[name]
        return observer.last_real_values(slave_index=slave, variable_references=[reference])[0]

    rows = []
    for _ in range(request["count"] // request["every"]):
        assert execution.step(step_count=request["every"])
        rows.append([result(name) for name in request["names"]])
    assert execution.status().current_time == round(request["count"] * request["step"] * 1e9)
    return rows


def ecos(file, request):
    from ecospy import EcosSimulation

    rows = []
    with EcosSimulation(ssp_path=file, step_size=request["step"]) as simulation:
        simulation.init(parameter_set=request["parameter_set"])
        for _ in range(request["count"] // request["every"]):
            simulation.step(request["every"])
            paths = (name.replace(".", "::", 1) for name in request["names"])
            rows.append([simulation.get_real(path) for path in paths])
        simulation.terminate()
    return rows


if __name__ == "__main__":
    master, file, request_file, answer_file = sys.argv[1:]
    request = json.loads(Path(request_file).read_text(encoding="utf-8"))
    rows = {"libcosim": libcosim, "ecos": ecos}[master](file, request)
    Path(answer_file).write_text(json.dumps(rows), encoding="utf-8")
    # pythonfmu 0.7 releases its interpreter twice when a process ends, which aborts some of them;
    # these masters give no handle on the FMU's library to prevent it.
    os._exit(0)
