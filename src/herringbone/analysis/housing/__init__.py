"""What every housing must do: the contract, and how a housing behaves from rest."""
