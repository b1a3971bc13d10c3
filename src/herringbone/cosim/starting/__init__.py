"""What a run begins with: values that reach all parts, speeds that fit, parts in steady motion."""
