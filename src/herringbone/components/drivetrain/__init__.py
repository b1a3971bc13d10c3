"""Parts of drivetrains around gearboxes, after Modelica.Mechanics.Rotational."""
